#include "sim/blob_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <sstream>

#include "base/weight_within.hpp"
#include "gaussdrift/error.hpp"
#include "particle/fgtd_points.hpp"

namespace gaussdrift {

namespace {

fgtd::Method method_by_name(const std::string& name) {
  std::string known;
  for (const fgtd::Method method : fgtd::methods()) {
    if (fgtd::to_string(method) == name) return method;
    known += (known.empty() ? "" : ", ") + fgtd::to_string(method);
  }
  throw InputError("evaluate.method = \"" + name + "\" is not a method of the Gauss transform; there are " + known);
}

}  // namespace

template <int d>
BlobSum<d>::BlobSum(const Particles& particles, const Cutoff& cutoff, const DensityOptions& options)
    : options_(options),
      sources_(points_of<d>(particles)),
      weights_(Eigen::Map<const Eigen::VectorXd>(particles.alpha.data(), static_cast<Eigen::Index>(particles.size()))),
      groups_(group_by_width(cutoff)) {}

template <int d>
std::vector<typename BlobSum<d>::WidthGroup> BlobSum<d>::group_by_width(const Cutoff& cutoff) {
  std::map<double, WidthGroup> groups;
  for (const CutoffTerm& term : cutoff) {
    WidthGroup& group = groups[term.width];
    group.sigma = 1 / (term.width * term.width);
    fgtd::Derivative<d> alpha{};
    for (int k = 0; k < d; ++k) alpha[static_cast<std::size_t>(k)] = term.derivative[static_cast<std::size_t>(k)];
    group.combination.push_back({alpha, term.coefficient});
    group.derivative_order = std::max(group.derivative_order, std::accumulate(alpha.begin(), alpha.end(), 0));
    group.scale += std::abs(term.coefficient) * fgtd::derivative_scale<d>(alpha, group.sigma);
  }
  std::vector<WidthGroup> list;
  for (auto& [width, group] : groups) list.push_back(std::move(group));
  return list;
}

template <int d>
double BlobSum<d>::error_of_unit_tolerance(const Particles& particles) const {
  double error = 0;
  for (const WidthGroup& group : groups_) {
    const double reach = std::sqrt((2 * std::log(1 / options_.tolerance) + 40) / group.sigma);
    error += group.scale * largest_weight_within(particles.view(), particles.alpha.data(), reach);
  }
  return error;
}

// The promise of fgtd is tolerance * N * (weight around the target); the simulator's is relative to max |rho|.
template <int d>
void BlobSum<d>::choose_tolerance(double unit_error, double maximum, DensityReport& report) {
  constexpr double coarsest = 0.1;  // nothing is gained above
  const double wanted = unit_error > 0 ? options_.tolerance * maximum / unit_error : coarsest;
  tolerance_ = std::clamp(wanted, fgtd::smallest_tolerance, coarsest);
  report.requested_tolerance = tolerance_;
  if (by_hand()) {
    const double bound = bound_by_hand();
    report.requested_tolerance = options_.tolerance;
    report.achievable = maximum > 0 ? bound / maximum : 0;
    return;
  }
  report.achievable = wanted >= fgtd::smallest_tolerance || maximum == 0
                          ? options_.tolerance
                          : fgtd::smallest_tolerance * unit_error / maximum;
}

template <int d>
double BlobSum<d>::bound_by_hand() const {
  const HermiteSpec& by_hand = *options_.hermite;
  double bound = 0;
  for (const WidthGroup& group : groups_)
    for (const fgtd::Term<d>& term : group.combination) {
      const auto of_term = fgtd::hermite_bound<d>(by_hand.r, by_hand.p, by_hand.n, term.derivative);
      if (!of_term)
        throw InputError(
            fmt::format("with evaluate.p = {} the error of `hermite` has no bound for this cutoff function. "
                        "Raise evaluate.p, or leave r, p and n out.",
                        by_hand.p));
      const int order = std::accumulate(term.derivative.begin(), term.derivative.end(), 0);
      bound += std::abs(term.coefficient) * std::pow(group.sigma, order / 2.0) * *of_term;
    }
  return bound * weights_.cwiseAbs().sum();
}

template <int d>
DensityWork BlobSum<d>::predict(const fgtd::TensorGrid& grid) const {
  DensityWork work;
  for (const WidthGroup& group : groups_) {
    fgtd::Options options = options_for(group, grid);
    options.most_seconds = 0;  // any work is more, so the plan tells how much and does nothing
    try {
      fgtd::Plan<d>(sources_, weights_, group.sigma, options);
    } catch (const fgtd::TimeLimitError& limit) {
      work.seconds += limit.seconds;
      work.method = to_string(limit.method);
    }
  }
  return work;
}

template <int d>
Eigen::VectorXd BlobSum<d>::transform(const fgtd::TensorGrid& grid, DensityReport& report) const {
  report.choice.clear();
  Eigen::VectorXd rho = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(grid.size()));
  for (const WidthGroup& group : groups_) {
    const fgtd::Plan<d> plan(sources_, weights_, group.sigma, options_for(group, grid));
    rho += plan.evaluate_combination(grid, group.combination);
    std::ostringstream text;
    text << plan.choice();
    if (!report.choice.empty()) report.choice += '\n';
    report.choice += text.str();
  }
  return rho;
}

template <int d>
Eigen::VectorXd BlobSum<d>::direct(const fgtd::Points<d>& targets) const {
  Eigen::VectorXd rho = Eigen::VectorXd::Zero(targets.cols());
  for (const WidthGroup& group : groups_) {
    fgtd::Options options;
    options.method = fgtd::Method::direct;
    options.derivative_order = group.derivative_order;
    options.threads = options_.threads;
    rho += fgtd::Plan<d>(sources_, weights_, group.sigma, options).evaluate_combination(targets, group.combination);
  }
  return rho;
}

template <int d>
fgtd::Options BlobSum<d>::options_for(const WidthGroup& group, const fgtd::TensorGrid& grid) const {
  fgtd::Options options;
  options.tolerance = tolerance_;
  options.derivative_order = group.derivative_order;
  options.method = method_by_name(options_.method);
  if (by_hand()) options.hermite = {options_.hermite->r, options_.hermite->p, options_.hermite->n};
  options.threads = options_.threads;
  options.expected_grid = grid;
  return options;
}

template <int d>
double BlobSum<d>::largest_error(const Lattice& lattice, const LatticeBox& box, const std::vector<double>& rho,
                                 const std::vector<std::size_t>& numbers) const {
  fgtd::Points<d> targets(d, static_cast<Eigen::Index>(numbers.size()));
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::size_t rest = numbers[i];
    for (int k = 0; k < d; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      targets(k, static_cast<Eigen::Index>(i)) = lattice.coordinate(k, box.first[axis] + rest % box.points[axis]);
      rest /= box.points[axis];
    }
  }
  const Eigen::VectorXd exact = direct(targets);
  double error = 0;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    error = std::max(error, std::abs(exact(static_cast<Eigen::Index>(i)) - rho[numbers[i]]));
  return error;
}

fgtd::TensorGrid nodes_of(const Lattice& lattice, const LatticeBox& box) {
  fgtd::TensorGrid nodes;
  for (int k = 0; k < lattice.dimension; ++k) {
    std::vector<double>& axis = nodes.axes.emplace_back(box.points[k]);
    for (std::size_t i = 0; i < axis.size(); ++i) axis[i] = lattice.coordinate(k, box.first[k] + i);
  }
  return nodes;
}

std::size_t number_of_largest(const std::vector<double>& rho) {
  const auto largest =
      std::max_element(rho.begin(), rho.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<std::size_t>(largest - rho.begin());
}

std::vector<std::size_t> spread_numbers(std::size_t size, std::size_t count) {
  constexpr double golden = 0.61803398874989485;  // multiples of the golden ratio fill [0, 1) evenly
  std::vector<std::size_t> numbers;
  for (std::size_t i = 1; i < count; ++i) {
    const double fraction = std::fmod(static_cast<double>(i) * golden, 1.0);
    numbers.push_back(std::min(size - 1, static_cast<std::size_t>(fraction * static_cast<double>(size))));
  }
  return numbers;
}

template class BlobSum<2>;
template class BlobSum<3>;

}  // namespace gaussdrift
