#include "sim/blob_sum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

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

template <int d, int e>
BlobSum<d, e>::BlobSum(const Particles& particles, const Cutoff& cutoff, const DensityOptions& options)
    : options_(options),
      sources_(points_of<d>(particles)),
      weights_(Eigen::Map<const Eigen::VectorXd>(particles.alpha.data(), static_cast<Eigen::Index>(particles.size()))),
      groups_(group_by_width(cutoff, options.derivatives)) {}

template <int d, int e>
std::vector<typename BlobSum<d, e>::WidthGroup> BlobSum<d, e>::group_by_width(
    const Cutoff& cutoff, const std::vector<DensityDerivatives>& wanted) {
  std::map<std::pair<double, Tensor>, WidthGroup> groups;
  for (const CutoffTerm& term : e == d ? cutoff : in_space(cutoff)) {
    WidthGroup& group = groups[{term.width, term.longer}];
    group.sphere = sphere_of(cutoff);
    group.sigma = term.is_round() ? 1 / (term.width * term.width) : 1;
    if (!term.is_round() && !group.round) group.round = round_coordinates(term);
    group.combinations.resize(1 + wanted.size());
    group.scale.resize(1 + wanted.size());
    const auto add_one = [&](std::size_t quantity, const std::array<int, max_dimension>& derivative,
                             double coefficient) {
      fgtd::Derivative<e> alpha{};
      for (std::size_t k = 0; k < e; ++k) alpha[k] = derivative[k];
      group.combinations[quantity].push_back({alpha, coefficient});
      group.derivative_order = std::max(group.derivative_order, std::accumulate(alpha.begin(), alpha.end(), 0));
      group.scale[quantity] += std::abs(coefficient) * fgtd::derivative_scale<e>(alpha, group.sigma);
    };
    const auto add = [&](std::size_t quantity, const std::array<int, max_dimension>& further) {
      std::array<int, max_dimension> derivative = term.derivative;
      for (std::size_t k = 0; k < d; ++k) derivative[k] += further[k];
      if (!group.round) return add_one(quantity, derivative, term.coefficient);
      for (const CutoffTerm& part : derivative_along(derivative, *group.round))
        add_one(quantity, part.derivative, term.coefficient * part.coefficient);
    };
    add(0, {});
    for (std::size_t q = 0; q < wanted.size(); ++q)
      for (const auto& derivative : wanted[q]) add(q + 1, derivative);
  }
  std::vector<WidthGroup> list;
  for (auto& [width, group] : groups) list.push_back(std::move(group));
  return list;
}

template <int d, int e>
fgtd::Points<e> BlobSum<d, e>::WidthGroup::in_its_coordinates(const fgtd::Points<d>& points) const {
  if constexpr (e == d)
    if (!round) return points;
  fgtd::Points<e> there(e, points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    Vector x{};
    for (int k = 0; k < d; ++k) x[static_cast<std::size_t>(k)] = points(k, i);
    const Vector y = e == d ? round->of(x) : point_of_sphere(sphere, x);
    for (int k = 0; k < e; ++k) there(k, i) = y[static_cast<std::size_t>(k)];
  }
  return there;
}

template <int d, int e>
std::optional<fgtd::TensorGrid> BlobSum<d, e>::WidthGroup::in_its_coordinates(const fgtd::TensorGrid& grid) const {
  if (e != d) return std::nullopt;
  if (!round) return grid;
  if (!round->keeps_axes()) return std::nullopt;
  fgtd::TensorGrid there = grid;
  for (std::size_t k = 0; k < d; ++k)
    for (double& node : there.axes[k]) node *= round->map[k][k];
  return there;
}

template <int d, int e>
double BlobSum<d, e>::WidthGroup::steepest_at(std::size_t axis) const {
  double square = sigma;  // of the factor of x_k^2 in the exponent
  if (round) {
    square = 0;
    for (std::size_t m = 0; m < d; ++m) square += round->map[m][axis] * round->map[m][axis];
  }
  return 1 / std::sqrt(2 * square);
}

template <int d, int e>
OfQuantities BlobSum<d, e>::error_of_unit_tolerance(const Particles& particles) const {
  OfQuantities errors(options_.quantities(), 0.0);
  for (const WidthGroup& group : groups_) {
    const double reach = std::sqrt((2 * std::log(1 / options_.tolerance) + 40) / group.sigma);
    PointsView places = particles.view();
    std::array<Eigen::VectorXd, e> columns;
    if (group.round || e != d) {
      const fgtd::Points<e> there = group.in_its_coordinates(points_of<d>(particles));
      places.dimension = e;
      for (std::size_t k = 0; k < e; ++k) {
        columns[k] = there.row(static_cast<Eigen::Index>(k)).transpose();
        places.axis[k] = columns[k].data();
      }
    }
    const double weight = largest_weight_within(places, particles.alpha.data(), reach);
    for (std::size_t q = 0; q < errors.size(); ++q) errors[q] += group.scale[q] * weight;
  }
  return errors;
}

// The promise of fgtd is tolerance * N * (weight around the target); the simulator's is relative to the maximum.
template <int d, int e>
void BlobSum<d, e>::choose_tolerance(const OfQuantities& unit_errors, const OfQuantities& maxima,
                                     DensityReport& report) {
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

template <int d, int e>
double BlobSum<d, e>::bound_by_hand(std::size_t quantity) const {
  const HermiteSpec& by_hand = *options_.hermite;
  double bound = 0;
  for (const WidthGroup& group : groups_)
    for (const fgtd::Term<e>& term : group.combinations[quantity]) {
      const auto of_term = fgtd::hermite_bound<e>(by_hand.r, by_hand.p, by_hand.n, term.derivative);
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

// The grid where its points count as one in the coordinates of a group, and else its points.
template <int d, int e>
class BlobSum<d, e>::Targets {
 public:
  Targets(const WidthGroup& group, const fgtd::TensorGrid& grid) : grid_(group.in_its_coordinates(grid)) {
    if (!grid_) points_ = group.in_its_coordinates(points_of_grid(grid));
  }

  void expect(fgtd::Options& options) const {
    if (grid_)
      options.expected_grid = grid_;
    else
      options.expected_targets = static_cast<std::size_t>(points_.cols());
  }
  Eigen::MatrixXd values(const fgtd::Plan<e>& plan, const std::vector<fgtd::Combination<e>>& combinations) const {
    return grid_ ? plan.evaluate_combinations(*grid_, combinations) : plan.evaluate_combinations(points_, combinations);
  }

 private:
  static fgtd::Points<d> points_of_grid(const fgtd::TensorGrid& grid) {
    fgtd::Points<d> points(d, static_cast<Eigen::Index>(grid.size()));
    for (std::size_t i = 0; i < grid.size(); ++i) {
      std::size_t rest = i;
      for (std::size_t k = 0; k < d; ++k) {
        points(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) = grid.axes[k][rest % grid.axes[k].size()];
        rest /= grid.axes[k].size();
      }
    }
    return points;
  }

  std::optional<fgtd::TensorGrid> grid_;
  fgtd::Points<e> points_;
};

template <int d, int e>
fgtd::Plan<e> BlobSum<d, e>::plan_of(const WidthGroup& group, const fgtd::Options& options) const {
  if constexpr (e == d)
    if (!group.round) return {sources_, weights_, group.sigma, options};
  return {group.in_its_coordinates(sources_), weights_, group.sigma, options};
}

template <int d, int e>
DensityWork BlobSum<d, e>::predict(const fgtd::TensorGrid& grid) const {
  DensityWork work;
  for (const WidthGroup& group : groups_) {
    fgtd::Options options = options_for(group);
    Targets(group, grid).expect(options);
    options.most_seconds = 0;  // any work is more, so the plan tells how much and does nothing
    try {
      plan_of(group, options);
    } catch (const fgtd::TimeLimitError& limit) {
      work.seconds += limit.seconds;
      work.method = to_string(limit.method);
    }
  }
  return work;
}

template <int d, int e>
Eigen::MatrixXd BlobSum<d, e>::transform(const fgtd::TensorGrid& grid, DensityReport& report) const {
  report.choice.clear();
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(grid.size()), static_cast<Eigen::Index>(options_.quantities()));
  for (const WidthGroup& group : groups_) {
    const Targets targets(group, grid);
    fgtd::Options options = options_for(group);
    targets.expect(options);
    const fgtd::Plan<e> plan = plan_of(group, options);
    values += targets.values(plan, group.combinations);
    if (!report.choice.empty()) report.choice += '\n';
    report.choice += base::printed(plan.choice());
  }
  return values;
}

template <int d, int e>
Eigen::MatrixXd BlobSum<d, e>::direct(const fgtd::Points<d>& targets) const {
  Eigen::MatrixXd values = Eigen::MatrixXd::Zero(targets.cols(), static_cast<Eigen::Index>(options_.quantities()));
  for (const WidthGroup& group : groups_) {
    fgtd::Options options;
    options.method = fgtd::Method::direct;
    options.derivative_order = group.derivative_order;
    options.threads = options_.threads;
    values += plan_of(group, options).evaluate_combinations(group.in_its_coordinates(targets), group.combinations);
  }
  return values;
}

template <int d, int e>
OfQuantities BlobSum<d, e>::largest_near(const fgtd::Points<d>& points) const {
  const auto largest_at = [&](const fgtd::Points<d>& targets) {
    const Eigen::RowVectorXd largest = direct(targets).cwiseAbs().colwise().maxCoeff();
    return OfQuantities(largest.begin(), largest.end());
  };
  OfQuantities largest = largest_at(points);
  if (options_.derivatives.empty()) return largest;
  for (int k = 0; k < d; ++k)
    for (const int side : {-1, 1}) {
      fgtd::Points<d> beside = points;
      beside.row(k).array() += side * groups_.front().steepest_at(static_cast<std::size_t>(k));
      OfQuantities there = largest_at(beside);
      there[0] = 0;  // the density's own bound is what it is without derivatives
      raise(largest, there);
    }
  return largest;
}

template <int d, int e>
fgtd::Options BlobSum<d, e>::options_for(const WidthGroup& group) const {
  fgtd::Options options;
  options.tolerance = tolerance_;
  options.derivative_order = group.derivative_order;
  options.method = method_by_name(options_.method);
  if (by_hand()) options.hermite = {options_.hermite->r, options_.hermite->p, options_.hermite->n};
  options.threads = options_.threads;
  return options;
}

template <int d, int e>
OfQuantities BlobSum<d, e>::largest_errors(const Lattice& lattice, const LatticeBox& box,
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
template class BlobSum<2, 3>;

}  // namespace gaussdrift
