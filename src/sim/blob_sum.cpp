#include "sim/blob_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "base/printed.hpp"
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
      groups_(group_by_width(cutoff, options.derivatives)) {}

template <int d>
std::vector<typename BlobSum<d>::WidthGroup> BlobSum<d>::group_by_width(const Cutoff& cutoff,
                                                                        const std::vector<DensityDerivatives>& wanted) {
  std::map<double, WidthGroup> groups;
  for (const CutoffTerm& term : cutoff) {
    WidthGroup& group = groups[term.width];
    group.sigma = 1 / (term.width * term.width);
    group.combinations.resize(1 + wanted.size());
    group.scale.resize(1 + wanted.size());
    const auto add = [&](std::size_t quantity, const std::array<int, max_dimension>& further) {
      fgtd::Derivative<d> alpha{};
      for (std::size_t k = 0; k < d; ++k) alpha[k] = term.derivative[k] + further[k];
      group.combinations[quantity].push_back({alpha, term.coefficient});
      group.derivative_order = std::max(group.derivative_order, std::accumulate(alpha.begin(), alpha.end(), 0));
      group.scale[quantity] += std::abs(term.coefficient) * fgtd::derivative_scale<d>(alpha, group.sigma);
    };
    add(0, {});
    for (std::size_t q = 0; q < wanted.size(); ++q)
      for (const auto& derivative : wanted[q]) add(q + 1, derivative);
  }
  std::vector<WidthGroup> list;
  for (auto& [width, group] : groups) list.push_back(std::move(group));
  return list;
}

template <int d>
OfQuantities BlobSum<d>::error_of_unit_tolerance(const Particles& particles) const {
  OfQuantities errors(options_.quantities(), 0.0);
  for (const WidthGroup& group : groups_) {
    const double reach = std::sqrt((2 * std::log(1 / options_.tolerance) + 40) / group.sigma);
    const double weight = largest_weight_within(particles.view(), particles.alpha.data(), reach);
    for (std::size_t q = 0; q < errors.size(); ++q) errors[q] += group.scale[q] * weight;
  }
  return errors;
}

// The promise of fgtd is tolerance * N * (weight around the target); the simulator's is relative to the maximum.
template <int d>
void BlobSum<d>::choose_tolerance(const OfQuantities& unit_errors, const OfQuantities& maxima, DensityReport& report) {
  constexpr double coarsest = 0.1;  // nothing is gained above
  const auto wanted = [&](std::size_t q) {
    return unit_errors[q] > 0 ? options_.tolerance * maxima[q] / unit_errors[q] : coarsest;
  };
  // Bound relative to the maximum.
  const auto achievable = [&](std::size_t q) {
    if (by_hand()) return maxima[q] > 0 ? bound_by_hand(q) / maxima[q] : 0;
    return wanted(q) >= fgtd::smallest_tolerance || maxima[q] == 0
               ? options_.tolerance
               : fgtd::smallest_tolerance * unit_errors[q] / maxima[q];
  };
  double finest = wanted(0);
  report.achievable = achievable(0);
  report.derivatives_achievable = 0;
  for (std::size_t q = 1; q < maxima.size(); ++q) {
    if (maxima[q] == 0) continue;  // nothing is known of its size
    finest = std::min(finest, wanted(q));
    report.derivatives_achievable = std::max(report.derivatives_achievable, achievable(q));
  }
  tolerance_ = std::clamp(finest, fgtd::smallest_tolerance, coarsest);
  report.requested_tolerance = by_hand() ? options_.tolerance : tolerance_;
}

template <int d>
double BlobSum<d>::bound_by_hand(std::size_t quantity) const {
  const HermiteSpec& by_hand = *options_.hermite;
  double bound = 0;
  for (const WidthGroup& group : groups_)
    for (const fgtd::Term<d>& term : group.combinations[quantity]) {
      const auto of_term = fgtd::hermite_bound<d>(by_hand.r, by_hand.p, by_hand.n, term.derivative);
      if (!of_term)
        throw InputError(
            fmt::format("with evaluate.p = {} the error of `hermite` has no bound for this cutoff function{}. "
                        "Raise evaluate.p, or leave r, p and n out.",
                        by_hand.p, quantity > 0 ? " and the derivatives of output.fields" : ""));
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
Eigen::MatrixXd BlobSum<d>::transform(const fgtd::TensorGrid& grid, DensityReport& report) const {
  report.choice.clear();
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(grid.size()), static_cast<Eigen::Index>(options_.quantities()));
  for (const WidthGroup& group : groups_) {
    const fgtd::Plan<d> plan(sources_, weights_, group.sigma, options_for(group, grid));
    values += plan.evaluate_combinations(grid, group.combinations);
    if (!report.choice.empty()) report.choice += '\n';
    report.choice += base::printed(plan.choice());
  }
  return values;
}

template <int d>
Eigen::MatrixXd BlobSum<d>::direct(const fgtd::Points<d>& targets) const {
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(targets.cols(), static_cast<Eigen::Index>(options_.quantities()));
  for (const WidthGroup& group : groups_) {
    fgtd::Options options;
    options.method = fgtd::Method::direct;
    options.derivative_order = group.derivative_order;
    options.threads = options_.threads;
    values +=
        fgtd::Plan<d>(sources_, weights_, group.sigma, options).evaluate_combinations(targets, group.combinations);
  }
  return values;
}

template <int d>
OfQuantities BlobSum<d>::largest_near(const fgtd::Points<d>& points) const {
  const auto largest_at = [&](const fgtd::Points<d>& targets) {
    const Eigen::RowVectorXd largest = direct(targets).cwiseAbs().colwise().maxCoeff();
    return OfQuantities(largest.begin(), largest.end());
  };
  OfQuantities largest = largest_at(points);
  if (options_.derivatives.empty()) return largest;
  for (int k = 0; k < d; ++k)
    for (const int side : {-1, 1}) {
      fgtd::Points<d> beside = points;
      beside.row(k).array() += side / std::sqrt(2 * groups_.front().sigma);  // where exp(-sigma r^2) is steepest
      OfQuantities there = largest_at(beside);
      there[0] = 0;  // the density's own bound is what it is without derivatives
      raise(largest, there);
    }
  return largest;
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
OfQuantities BlobSum<d>::largest_errors(const Lattice& lattice, const LatticeBox& box,
                                        const std::vector<double>& values,
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
  const Eigen::MatrixXd exact = direct(targets);
  OfQuantities errors(options_.quantities(), 0.0);
  for (std::size_t q = 0; q < errors.size(); ++q)
    for (std::size_t i = 0; i < numbers.size(); ++i)
      errors[q] = std::max(errors[q], std::abs(exact(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(q)) -
                                               values[q * box.size() + numbers[i]]));
  return errors;
}

fgtd::TensorGrid nodes_of(const Lattice& lattice, const LatticeBox& box) {
  fgtd::TensorGrid nodes;
  for (int k = 0; k < lattice.dimension; ++k) {
    std::vector<double>& axis = nodes.axes.emplace_back(box.points[k]);
    for (std::size_t i = 0; i < axis.size(); ++i) axis[i] = lattice.coordinate(k, box.first[k] + i);
  }
  return nodes;
}

std::size_t number_of_largest(std::span<const double> values) {
  const auto largest =
      std::max_element(values.begin(), values.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
  return static_cast<std::size_t>(largest - values.begin());
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
