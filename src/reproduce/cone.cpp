#include "reproduce/cone.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/stopwatch.hpp"
#include "field/density/radial_density.hpp"
#include "field/named/named_fields.hpp"
#include "particle/seeding.hpp"
#include "reproduce/published.hpp"
#include "sim/stepper.hpp"
#include "sim/transform.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::reproduce {

namespace {

// Table 5.1: rows c, the height at t = 0 in a column "ng100" a lattice. Table 5.2: rows c, the height on the lattice of
// 300 in a column a time.
struct Tables {
  PublishedTable first{"schroeder-table-5.1"}, second{"schroeder-table-5.2"};
};

int overlap_of(const PublishedTable& table, std::size_t row) { return static_cast<int>(*table.number(row, "c")); }
int lattice_of(const std::string& column) { return std::stoi(column.substr(2)); }

struct Moment {
  const char* column;
  const char* name;
  double turns;
};
constexpr std::array<Moment, 3> moments{{{"t0", "0", 0}, {"t2pi", "2 pi", 1}, {"t20pi", "20 pi", 10}}};

constexpr int evaluation_points = 700;  // n_ge
constexpr double step = 0.001;          // tau
constexpr Vector low{-1, -1, 0}, high{1, 1, 0};

double height(const Cone& cone, int overlap, int threads) {
  static const Lattice grid = make_lattice(2, low, high, evaluation_points);
  DensityOptions options;
  options.tolerance = 1e-9;  // far below the printed digits
  options.threads = threads;
  options.measure = false;
  const Cutoff cutoff = make_cutoff("gauss2", 2, overlap * cone.seeding.spacing);
  const DensityGrid density = evaluate_density(cone.particles, cutoff, grid, options);
  return *std::max_element(density.rho.begin(), density.rho.end());
}

}  // namespace

Cone seed_cone(int per_axis, int threads) {
  const RadialDensity wendland(RadialDensity::Profile::wendland, 2, {0.5, 0, 0}, 0.25, 1);
  Cone cone;
  cone.seeding = make_lattice(2, low, high, per_axis);
  cone.particles = seed(
      cone.seeding, [&](const PointsView& x, double* values) { wendland.add(x, values); }, threads);
  return cone;
}

ConeReproduction reproduce_cone(int threads, const std::function<void(std::size_t, std::size_t)>& progress) {
  const base::Stopwatch watch;
  ConeReproduction result;
  const auto [first, second] = Tables();
  const std::size_t total = first.rows() * (first.columns().size() - 1) + second.rows() * moments.size();
  const auto add = [&](ConeHeight entry) {
    result.worst_difference = std::max(result.worst_difference, std::abs(entry.computed - entry.published));
    result.heights.push_back(std::move(entry));
    if (progress) progress(result.heights.size(), total);
  };

  for (std::size_t i = 1; i < first.columns().size(); ++i) {
    const std::string& column = first.columns()[i];
    const int per_axis = lattice_of(column);
    const Cone cone = seed_cone(per_axis, threads);
    for (std::size_t row = 0; row < first.rows(); ++row) {
      const int overlap = overlap_of(first, row);
      add({51, per_axis, overlap, "0", *first.number(row, column), height(cone, overlap, threads)});
    }
  }

  // The paper takes floor(t / tau) full steps and stops short of t; the heights show it.
  Cone cone = seed_cone(300, threads);
  const auto rotation = make_named_field("rotation", {.dimension = 2});
  const Stepper stepper(*rotation, time::find_tableau("rk4"), threads);
  std::size_t taken = 0;
  for (const Moment& moment : moments) {
    const auto wanted = static_cast<std::size_t>(std::floor(moment.turns * 2 * std::numbers::pi / step));
    const time::Interval interval(static_cast<double>(taken) * step, static_cast<double>(wanted) * step, step);
    stepper.advance(cone.particles, interval, 0, interval.steps(), taken);
    taken = wanted;
    for (std::size_t row = 0; row < second.rows(); ++row) {
      const int overlap = overlap_of(second, row);
      add({52, 300, overlap, moment.name, *second.number(row, moment.column), height(cone, overlap, threads)});
    }
  }
  result.seconds = watch.seconds();
  return result;
}

std::string to_text(const ConeReproduction& result) {
  // A published number, and beside it the computed one in the units of its last digit.
  const auto find = [&](int table, int overlap, int per_axis, const std::string& time) -> const ConeHeight& {
    return *std::find_if(result.heights.begin(), result.heights.end(), [&](const ConeHeight& entry) {
      return entry.table == table && entry.overlap == overlap && entry.per_axis == per_axis && entry.time == time;
    });
  };
  const auto cell = [](const ConeHeight& entry) {
    return fmt::format("  {:.6f} {:.7f}", entry.published, entry.computed);
  };

  std::string text = "Schroeder 2006, Table 5.1: height of the cone at t = 0 (published, computed)\n   c";
  const auto [first, second] = Tables();
  for (std::size_t i = 1; i < first.columns().size(); ++i)
    text += fmt::format("  {:>18}", fmt::format("n_g = {}", lattice_of(first.columns()[i])));
  text += "\n";
  for (std::size_t row = 0; row < first.rows(); ++row) {
    const int overlap = overlap_of(first, row);
    text += fmt::format("{:4}", overlap);
    for (std::size_t i = 1; i < first.columns().size(); ++i)
      text += cell(find(51, overlap, lattice_of(first.columns()[i]), "0"));
    text += "\n";
  }
  text += "\nSchroeder 2006, Table 5.2: height of the cone at time t, n_g = 300 (published, computed)\n   c";
  for (const Moment& moment : moments) text += fmt::format("  {:>18}", std::string("t = ") + moment.name);
  text += "\n";
  for (std::size_t row = 0; row < second.rows(); ++row) {
    const int overlap = overlap_of(second, row);
    text += fmt::format("{:4}", overlap);
    for (const Moment& moment : moments) text += cell(find(52, overlap, 300, moment.name));
    text += "\n";
  }
  text += fmt::format(
      "\ncompared: {} heights, equal digits; largest difference {:.1e} (printed to 1e-6, agreement: at most {:.0e}); "
      "{:.1f} s\n",
      result.heights.size(), result.worst_difference, cone_agreement, result.seconds);
  return text;
}

std::string to_json(const ConeReproduction& result) {
  nlohmann::ordered_json heights = nlohmann::ordered_json::array();
  for (const ConeHeight& entry : result.heights)
    heights.push_back({{"table", entry.table == 51 ? "5.1" : "5.2"},
                       {"n_g", entry.per_axis},
                       {"c", entry.overlap},
                       {"t", entry.time},
                       {"published", entry.published},
                       {"computed", entry.computed}});
  const nlohmann::ordered_json document{{"source", "Schroeder 2006, Tables 5.1 and 5.2"},
                                        {"heights", heights},
                                        {"worst_difference", result.worst_difference},
                                        {"agreement", cone_agreement},
                                        {"seconds", result.seconds}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::reproduce
