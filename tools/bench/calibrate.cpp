// Fits the constants of cost, src/fgtd/cost.hpp and those of the methods, to this machine and prints these headers with the
// new numbers.
//
// Every method is timed over a sweep of workloads (sweep_points.hpp). A prediction p_i depends smoothly on the
// constants c_k, so that with e_ik = d ln p_i / d ln c_k, by differences, the steps x_k = ln(c_k new / c_k) minimise
//   sum_i ( ln(measured_i / p_i) - sum_k e_ik x_k )^2 + damping sum_k x_k^2.
// Constants on which no measured time depends stay as they are. A few rounds, because other constants mean other
// parameters. Run it alone on the machine; processor time is what counts.
//
//   calibrate [points = 120] [rounds = 3] > costs.txt
#include <Eigen/Dense>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <regex>
#include <sstream>

#include "fgtd/cost.hpp"
#include "registered.hpp"
#include "sweep_points.hpp"

namespace {

constexpr double limit = 1.0;           // seconds that a run may be predicted to take
constexpr double shortest = 0.3e-3;     // below, the clock and the choice itself are measured
constexpr double damping = 0.5;         // of points: keeps what the sweep does not see
constexpr double step = 0.05;           // of ln c_k in a difference
constexpr double largest_change = 1.1;  // of ln c_k in a round

struct Constant {
  std::string name;
  double* value;
};

std::vector<Constant> constants() {
  std::vector<Constant> list;
  for (const bench::Registered& registered : bench::Registered::all())
    for (std::size_t i = 0; i < registered.count; ++i) list.push_back({registered.name, registered.value + i});
  return list;
}

/// One row for every point and method: the elasticities, and ln(measured / predicted).
struct Rows {
  std::vector<Eigen::VectorXd> elasticity;
  std::vector<double> excess;
};

template <int d>
void add_rows(const bench::SweepTask<d>& task, const std::vector<Constant>& list, Rows& rows) {
  for (const fgtd::Method method : fgtd::methods()) {
    if (method == fgtd::Method::automatic) continue;
    const bench::Timing timing = task.time(method, limit);
    if (!timing.done || timing.choice.method != method || timing.seconds < shortest) continue;
    Eigen::VectorXd elasticity = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(list.size()));
    for (std::size_t k = 0; k < list.size(); ++k) {
      const double kept = *list[k].value;
      const auto predicted = [&](double factor) {
        *list[k].value = kept * factor;
        const double seconds = task.predict(method).seconds;
        *list[k].value = kept;
        return seconds;
      };
      elasticity[static_cast<Eigen::Index>(k)] =
          std::log(predicted(std::exp(step)) / predicted(std::exp(-step))) / (2 * step);
    }
    rows.elasticity.push_back(elasticity);
    rows.excess.push_back(std::log(timing.seconds / timing.choice.seconds));
  }
}

/// Mean |ln(measured / predicted)| before the step.
double improve(const Rows& rows, const std::vector<Constant>& list) {
  const Eigen::Index count = static_cast<Eigen::Index>(list.size());
  Eigen::MatrixXd normal = damping * Eigen::MatrixXd::Identity(count, count);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(count);
  double deviation = 0;
  for (std::size_t i = 0; i < rows.excess.size(); ++i) {
    normal += rows.elasticity[i] * rows.elasticity[i].transpose();
    right += rows.excess[i] * rows.elasticity[i];
    deviation += std::abs(rows.excess[i]);
  }
  const Eigen::VectorXd change = normal.ldlt().solve(right);
  for (std::size_t k = 0; k < list.size(); ++k)
    *list[k].value *= std::exp(std::clamp(change[static_cast<Eigen::Index>(k)], -largest_change, largest_change));
  return deviation / static_cast<double>(std::max<std::size_t>(1, rows.excess.size()));
}

/// "0.45e-9" as the header writes times; plain numbers for factors.
std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, value < 1e-6 ? "%.2ge-9" : "%.2g", value < 1e-6 ? value * 1e9 : value);
  return buffer;
}

/// A header with the present values in place of the numbers.
void print_header(const std::string& header) {
  std::ifstream file(SOURCES + header);
  std::cout << "---- src/" << header << "\n";
  const std::regex line_of_constant(R"((constexpr double ([a-z_0-9]+)(\[\d\])? = )[^;]*;(.*))");
  for (std::string line; std::getline(file, line);) {
    std::smatch parts;
    if (std::regex_match(line, parts, line_of_constant)) {
      for (const bench::Registered& registered : bench::Registered::all()) {
        if (registered.name != parts[2]) continue;
        std::string numbers;
        for (std::size_t i = 0; i < registered.count; ++i) numbers += (i > 0 ? ", " : "") + text(registered.value[i]);
        line = parts[1].str() + (registered.count > 1 ? "{" + numbers + "}" : numbers) + ";" + parts[4].str();
      }
    }
    std::cout << line << "\n";
  }
}

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 120, rounds = argc > 2 ? std::atoi(argv[2]) : 3;
  const std::vector<Constant> list = constants();
  for (int round = 0; round < rounds; ++round) {
    Rows rows;
    for (const bench::SweepPoint& point : bench::sweep_points(count))
      bench::with_task(point, [&](const auto& task) {
        try {
          add_rows(task, list, rows);
        } catch (const fgtd::Error&) {  // a method that is beyond the memory limit here
        }
      });
    const double deviation = improve(rows, list);
    std::fprintf(stderr, "round %d: %zu timings, measured and predicted a factor of %.2f apart\n", round + 1,
                 rows.excess.size(), std::exp(deviation));
  }
  std::istringstream headers(COST_HEADERS);
  for (std::string header; std::getline(headers, header, ',');) print_header(header);
  return 0;
}
