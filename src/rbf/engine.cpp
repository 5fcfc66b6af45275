#include "rbf/engine.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "base/parallel.hpp"
#include "rbf/check.hpp"
#include "rbf/derivatives.hpp"

namespace rbf {
namespace detail {
namespace {

constexpr double smallest_of_fgtd = 10 * fgtd::smallest_tolerance;
constexpr double largest_of_fgtd = 0.3;
constexpr double transform_seconds = 0.3e-3;  // the least that a Gauss transform takes: its search for parameters
constexpr double point_seconds = 20e-9;       // and for a centre or target
constexpr double usual_terms = 8;

// The near field, measured with bench_rbf. By dimension: centres within its radius of a target, and pairs that are looked
// at for each of them.
constexpr double neighbours[] = {30, 30, 30};
constexpr double looked_at[] = {1.5, 2.9, 6.4};
constexpr double near_point_seconds = 60e-9;  // sorting a centre or target
constexpr double near_pair_factor = 1.3;      // in pairs of `direct`
// The near field takes as long as so many Gauss transforms, by dimension. Gaussians that are narrower than its radius
// follow each other by factors of about exp(1.4) in t, and begin where the integral's end is about 30 times beyond.
constexpr double near_transforms[] = {2, 4, 0};
constexpr double step_of_narrow = 1.4, end_beyond_narrow = 30;

// Parts of the tolerance: most is left to the Gauss transforms.
constexpr double kernel_part = 0.5, near_part = 0.01, used = 0.98;

/// Numbers from one point to the next. One-dimensional points are a row, which Eigen keeps row-major.
template <int d>
std::size_t stride(const Eigen::Ref<const Points<d>>& points) {
  return d == 1 ? 1 : static_cast<std::size_t>(points.outerStride());
}

template <int d>
double farthest_corner(const Eigen::Matrix<double, d, 1>& low, const Eigen::Matrix<double, d, 1>& high,
                       const double* target) {
  double squared = 0;
  for (int l = 0; l < d; ++l) {
    const double far = std::max(std::abs(target[l] - low[l]), std::abs(high[l] - target[l]));
    squared += far * far;
  }
  return std::sqrt(squared);
}

/// What fgtd says, with the words of this library around it.
template <class Work>
auto with_fgtd(const Work& work) {
  try {
    return work();
  } catch (const fgtd::MemoryLimitError& error) {
    throw MemoryLimitError("rbf: the Gaussians need more memory than Options::memory_limit. " +
                               std::string(error.what()) + "; raise the limit, or evaluate fewer targets at a time",
                           error.needed, error.limit);
  } catch (const fgtd::InvalidArgument& error) {
    throw InvalidArgument("rbf: " + std::string(error.what()));
  } catch (const fgtd::ToleranceError& error) {
    throw ToleranceError("rbf: " + std::string(error.what()));
  }
}

/// Largest |D^alpha exp(-t r^2)| with |alpha| = j that fgtd's tolerance is relative to.
double fgtd_scale(int j, double t) {
  if (j == 0) return 1;
  return j == 1 ? std::sqrt(2 * t) : std::sqrt(8.0) * t;
}

}  // namespace

template <int d>
Engine<d>::Engine(const Function& function, const Eigen::Ref<const Points<d>>& centres,
                  const Eigen::Ref<const Eigen::MatrixXd>& weights, const Options& options)
    : function_(function), options_(options) {
  check_function(function);
  check_options(function, options);
  if (options.expected_grid) check_grid("Options::expected_grid", *options.expected_grid, d);
  const std::size_t count = static_cast<std::size_t>(centres.cols());
  check_points("centre", centres.data(), d, count, stride<d>(centres), options.threads);
  check_weights(weights, count, options.threads);
  columns_ = weights.cols();
  check_memory("the plan", 8.0 * static_cast<double>(count) * (2.0 * d + static_cast<double>(columns_)),
               options.memory_limit);

  low_.setZero();
  high_.setZero();
  if (count > 0) {
    low_ = centres.rowwise().minCoeff();
    high_ = centres.rowwise().maxCoeff();
  }
  origin_ = low_ + (high_ - low_) / 2;
  centres_ = centres.colwise() - origin_;

  choice_.function = function;
  choice_.tolerance = options.tolerance;
  choice_.range = options.range > 0 ? options.range : (high_ - low_).norm();
  if (!(choice_.range <= 1e75))
    throw InvalidArgument("rbf: the centres are " + text(choice_.range) +
                          " apart, must be at most 1e75; take another unit of length");
  choice_.largest = largest(function, choice_.range, 0).of[0];
  choice_.centres = count;
  choice_.targets = options.expected_grid          ? options.expected_grid->size()
                    : options.expected_targets > 0 ? options.expected_targets
                                                   : count;
  const double direct = direct_seconds(),
               least = usual_terms * (transform_seconds + point_seconds * static_cast<double>(count + choice_.targets));
  const bool impossible = !(choice_.range > 1e-75) || options.tolerance < smallest_tolerance || count == 0;
  bool gaussians = options.method == Method::gaussians && !impossible;
  if (options.method == Method::automatic && !impossible && direct > least) gaussians = true;
  if (gaussians) {
    try {
      plan_gaussians(weights);
      gaussians = options.method == Method::gaussians || choice_.seconds < direct;
    } catch (const ToleranceError&) {
      if (options.method == Method::gaussians) throw;
      gaussians = false;
    }
  }
  if (gaussians) {
    check_seconds(Method::gaussians, choice_.seconds, options.most_seconds);
  } else {
    check_seconds(Method::direct, direct, options.most_seconds);
    gaussians_.reset();
    choice_.terms.clear();
    choice_.method = Method::direct;
    choice_.seconds = direct;
    choice_.polynomial = {};
    choice_.near = choice_.kernel_error = choice_.bound = 0;
    near_.reset();
    direct_.emplace(function, centres_, options.threads);
    direct_->set_weights(weights);
  }
}

template <int d>
double Engine<d>::direct_seconds() const {
  return static_cast<double>(choice_.centres) * static_cast<double>(choice_.targets) *
         static_cast<double>(std::max<Eigen::Index>(1, columns_)) * pair_seconds(function_.kernel);
}

template <int d>
Expansion Engine<d>::expand_kernel() {
  const int order = options_.derivative_order;
  const double accuracy = kernel_part * options_.tolerance,
               points = static_cast<double>(choice_.centres + choice_.targets);
  const double close = neighbours[d - 1], radius = distance_of_neighbours<d>(centres_, close);
  CellGrid<d> lattice;
  Smooth smooth;
  // How narrow the narrowest Gaussian has to be for a near field to pay.
  const double narrow = gone * end_beyond_narrow * std::exp(step_of_narrow * near_transforms[d - 1]);
  if (function_.kernel != Kernel::gaussian && radius > 0 && radius < choice_.range / 4 &&
      finest_exponent(function_, choice_.range, order, accuracy) * radius * radius > narrow &&
      CellGrid<d>::make(low_ - origin_, high_ - origin_, radius * (1 + 1e-9), lattice)) {
    try {
      const Expansion beyond = expand(function_, choice_.range, radius, order, accuracy);
      if (make_smooth(beyond, radius, order, near_part * options_.tolerance, smooth)) {
        choice_.near = radius;
        choice_.seconds = points * near_point_seconds +
                          static_cast<double>(choice_.targets) * close * looked_at[d - 1] * near_pair_factor *
                              pair_seconds(function_.kernel) * static_cast<double>(std::max<Eigen::Index>(1, columns_));
        near_.emplace(function_, lattice, radius, smooth, centres_, options_.threads);
        return beyond;
      }
    } catch (const ToleranceError&) {  // the whole range may do
    }
  }
  return expand(function_, choice_.range, 0, order, accuracy);
}

template <int d>
void Engine<d>::plan_gaussians(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  const int order = options_.derivative_order;
  const Expansion sum = expand_kernel();
  choice_.method = Method::gaussians;
  choice_.polynomial = sum.polynomial;
  choice_.kernel_error = sum.error;
  choice_.bound = sum.error + (near_ ? near_part * options_.tolerance : 0);
  moments_ = Moments<d>(sum.polynomial, centres_, weights);
  if (near_) near_->set_weights(weights);
  const double count = static_cast<double>(sum.terms.size()), left = used * options_.tolerance - choice_.bound;
  std::optional<TensorGrid> grid = options_.expected_grid;
  if (grid)
    for (std::size_t l = 0; l < d; ++l)
      for (double& node : grid->axes[l]) node -= origin_[static_cast<Eigen::Index>(l)];
  std::vector<fgtd::Gaussian> gaussians;
  for (const WeightedGaussian& term : sum.terms) {
    double tolerance = largest_of_fgtd;
    for (int j = 0; j <= order; ++j)
      tolerance =
          std::min(tolerance, left / count * sum.scales.of[j] / (std::abs(term.weight) * fgtd_scale(j, term.exponent)));
    if (tolerance < smallest_of_fgtd)
      throw ToleranceError("rbf: Options::tolerance = " + text(options_.tolerance) + " cannot be promised for " +
                           to_string(function_.kernel) + " on [0, " + text(choice_.range) + "]: a Gaussian of weight " +
                           text(term.weight) + " would have to be right to " + text(tolerance) +
                           "; raise the tolerance, or take Method::direct");
    gaussians.push_back({term.exponent, term.weight, tolerance});
    double worst = 0;
    for (int j = 0; j <= order; ++j)
      worst = std::max(worst, std::abs(term.weight) * fgtd_scale(j, term.exponent) / sum.scales.of[j]);
    choice_.bound += worst * tolerance;
  }
  const fgtd::Options options{.derivative_order = order,
                              .threads = options_.threads,
                              .memory_limit = options_.memory_limit,
                              .expected_targets = options_.expected_targets,
                              .expected_grid = grid};
  gaussians_.emplace(with_fgtd([&] { return fgtd::Mixture<d>(centres_, weights, gaussians, options); }));
  choice_.transforms = 0;
  for (std::size_t k = 0; k < gaussians.size(); ++k) {
    const fgtd::Choice& chosen = gaussians_->choices()[k];
    choice_.seconds += chosen.seconds;
    choice_.terms.push_back({gaussians[k].sigma, gaussians[k].coefficient, chosen});
    choice_.transforms = std::max(choice_.transforms, gaussians_->groups()[k] + 1);
  }
}

template <int d>
void Engine<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  check_weights(weights, choice_.centres, options_.threads);
  columns_ = weights.cols();
  if (direct_) {
    direct_->set_weights(weights);
    return;
  }
  moments_ = Moments<d>(choice_.polynomial, centres_, weights);
  if (near_) near_->set_weights(weights);
  with_fgtd([&] { gaussians_->set_weights(weights); });
}

template <int d>
void Engine<d>::check_combinations(const std::vector<Combination<d>>& combinations) const {
  for (const Combination<d>& combination : combinations)
    for (const fgtd::Term<d>& term : combination) {
      int order = 0;
      for (const int along : term.derivative) {
        if (along < 0) throw InvalidArgument("rbf: a derivative of order " + std::to_string(along) + " was asked for");
        order += along;
      }
      if (order > options_.derivative_order)
        throw InvalidArgument("rbf: a derivative of order " + std::to_string(order) +
                              " was asked for, Options::derivative_order is " +
                              std::to_string(options_.derivative_order));
      if (!std::isfinite(term.coefficient))
        throw InvalidArgument("rbf: a coefficient of a combination is " + text(term.coefficient) +
                              "; coefficients must be finite");
    }
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const Eigen::Ref<const Points<d>>& targets,
                                    const std::vector<Combination<d>>& combinations) const {
  const std::size_t count = static_cast<std::size_t>(targets.cols());
  check_points("target", targets.data(), d, count, stride<d>(targets), options_.threads);
  check_combinations(combinations);
  const double allowed = choice_.range * (1 + 1e-12);
  for (std::size_t i = 0; i < count && choice_.centres > 0; ++i) {
    const double far = farthest_corner<d>(low_, high_, targets.data() + i * stride<d>(targets));
    if (far > allowed)
      throw InvalidArgument("rbf: target " + std::to_string(i) + " is " + text(far) +
                            " from a corner of the box around the centres, Options::range is " + text(choice_.range) +
                            "; give a larger range, rbf::range_of() tells which");
  }
  check_memory("the evaluation",
               8.0 * static_cast<double>(count) *
                   (d + 2.0 * static_cast<double>(combinations.size()) * static_cast<double>(columns_)),
               options_.memory_limit);
  const Points<d> shifted = targets.colwise() - origin_;
  return evaluate(
      count, combinations,
      [&](std::size_t i, double* coordinates) { std::copy_n(shifted.data() + i * d, d, coordinates); },
      [&] { return gaussians_->evaluate_combinations(shifted, combinations); }, shifted.data());
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const {
  check_grid("grid", grid, d);
  check_combinations(combinations);
  double nodes = 1;
  for (const std::vector<double>& axis : grid.axes) nodes *= static_cast<double>(axis.size());
  if (nodes > 0 && choice_.centres > 0)
    for (int corner = 0; corner < 1 << d; ++corner) {
      double at[d];
      for (std::size_t l = 0; l < d; ++l) at[l] = (corner >> l & 1) ? grid.axes[l].back() : grid.axes[l].front();
      const double far = farthest_corner<d>(low_, high_, at);
      if (far > choice_.range * (1 + 1e-12))
        throw InvalidArgument("rbf: the grid reaches to " + text(far) +
                              " from a corner of the box around the centres, Options::range is " + text(choice_.range) +
                              "; give a larger range");
    }
  check_memory("the evaluation",
               16.0 * nodes * static_cast<double>(combinations.size()) * static_cast<double>(columns_),
               options_.memory_limit);
  TensorGrid shifted = grid;
  for (std::size_t l = 0; l < d; ++l)
    for (double& node : shifted.axes[l]) node -= origin_[static_cast<Eigen::Index>(l)];
  return evaluate(
      grid.size(), combinations,
      [&](std::size_t i, double* coordinates) {
        for (std::size_t l = 0; l < d; ++l) {
          const std::vector<double>& axis = shifted.axes[l];
          coordinates[l] = axis[i % axis.size()];
          i /= axis.size();
        }
      },
      [&] { return gaussians_->evaluate_combinations(shifted, combinations); }, nullptr);
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(std::size_t count, const std::vector<Combination<d>>& combinations,
                                    const std::function<void(std::size_t, double*)>& point,
                                    const std::function<Eigen::MatrixXd()>& of_gaussians, const double* packed) const {
  if (direct_) return direct_->evaluate(count, combinations, point);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(count), columns_ * static_cast<Eigen::Index>(combinations.size()));
  const std::size_t columns = static_cast<std::size_t>(columns_);
  Points<d> unpacked(d, near_ && !packed ? static_cast<Eigen::Index>(count) : 0);
  constexpr std::size_t piece = 4096;
  gaussdrift::base::parallel_for({(count + piece - 1) / piece, 1e-8 * static_cast<double>(values.size())},
                                 options_.threads, [&](std::size_t i) {
                                   double at[d];
                                   for (std::size_t j = i * piece; j < std::min(count, (i + 1) * piece); ++j) {
                                     point(j, at);
                                     if (unpacked.cols() > 0) std::copy_n(at, d, unpacked.data() + j * d);
                                     for (std::size_t q = 0; q < combinations.size(); ++q)
                                       for (std::size_t column = 0; column < columns; ++column) {
                                         double sum = 0;
                                         for (const fgtd::Term<d>& term : combinations[q])
                                           sum += term.coefficient * moments_.sum(term.derivative, column, at);
                                         values.data()[(q * columns + column) * count + j] = sum;
                                       }
                                   }
                                 });
  if (near_) near_->add(packed ? packed : unpacked.data(), count, combinations, values);
  values += with_fgtd(of_gaussians);
  return values;
}

template class Engine<1>;
template class Engine<2>;
template class Engine<3>;

}  // namespace detail

template <int d>
double range_of(const Eigen::Ref<const Points<d>>& centres, const Eigen::Ref<const Points<d>>& targets) {
  if (centres.cols() == 0 || targets.cols() == 0) return 0;
  const Eigen::Matrix<double, d, 1> low = centres.rowwise().minCoeff(), high = centres.rowwise().maxCoeff();
  double range = 0;
  for (Eigen::Index i = 0; i < targets.cols(); ++i) {
    const Eigen::Matrix<double, d, 1> target = targets.col(i);
    range = std::max(range, detail::farthest_corner<d>(low, high, target.data()));
  }
  return range;
}

template double range_of<1>(const Eigen::Ref<const Points<1>>&, const Eigen::Ref<const Points<1>>&);
template double range_of<2>(const Eigen::Ref<const Points<2>>&, const Eigen::Ref<const Points<2>>&);
template double range_of<3>(const Eigen::Ref<const Points<3>>&, const Eigen::Ref<const Points<3>>&);

}  // namespace rbf
