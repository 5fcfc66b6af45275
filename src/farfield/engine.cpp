#include "farfield/engine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <type_traits>

#include "base/parallel.hpp"
#include "farfield/check.hpp"
#include "farfield/choose.hpp"
#include "farfield/images/copies.hpp"
#include "farfield/ranks/shared_site.hpp"

namespace farfield::detail {
namespace {

constexpr int largest_exponent = 1000;  // of units that are powers of 2, so that their inverse is a number

/// Numbers from one point to the next. One-dimensional points are a row, which Eigen keeps row-major.
template <int d>
std::size_t stride(const Eigen::Ref<const Points<d>>& points) {
  return d == 1 ? 1 : static_cast<std::size_t>(points.outerStride());
}

/// Half the lowest and highest coordinate of every axis: no difference of them exceeds the range.
struct Box {
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  template <int d>
  void include(const Eigen::Ref<const Points<d>>& points) {
    if (points.cols() == 0) return;
    for (int l = 0; l < d; ++l) {
      low[l] = std::min(low[l], points.row(l).minCoeff() / 2);
      high[l] = std::max(high[l], points.row(l).maxCoeff() / 2);
    }
  }
  /// Includes the points of all ranks.
  void include_all(const Channel& channel) {
    std::vector<double> ends;
    for (int l = 0; l < 3; ++l) ends.insert(ends.end(), {-low[l], high[l]});
    channel.max(ends);
    for (std::size_t l = 0; l < 3; ++l) low[l] = -ends[2 * l], high[l] = ends[2 * l + 1];
  }
  /// This is subtracted from coordinate l, so that the rest is at most twice the extent. The difference is exact: if
  /// points are farther from 0 than they extend, all of them lie between the nearest and twice the nearest.
  double origin(int l) const {
    const double extent = high[l] - low[l];
    if (low[l] > extent) return 2 * low[l];
    return high[l] < -extent ? 2 * high[l] : 0;
  }
  /// The exponent of the smallest power of 2 above the extent; 0 for one point.
  int exponent() const {
    double extent = 0;
    for (int l = 0; l < 3; ++l)
      if (low[l] <= high[l]) extent = std::max(extent, high[l] - low[l]);
    if (extent == 0) return 0;
    return std::clamp(std::ilogb(extent) + 2, -largest_exponent, largest_exponent);
  }
};

/// Points as columns brought to axes of their own, shifted and scaled, with zeros for axes that they do not have.
template <int d>
void take(const Eigen::Ref<const Points<d>>& points, const Box& box, int dimension, int exponent, int threads,
          Coordinates& to) {
  constexpr std::size_t piece = 1 << 14;
  const std::size_t count = static_cast<std::size_t>(points.cols());
  const double scale = std::ldexp(1.0, -exponent);
  for (std::size_t l = 0; l < static_cast<std::size_t>(dimension); ++l) {
    to[l].resize(count + padding);
    const double origin = count > 0 && l < d ? box.origin(static_cast<int>(l)) : 0;
    gaussdrift::base::parallel_for(
        {(count + piece - 1) / piece, 1e-9 * static_cast<double>(count)}, threads, [&](std::size_t i) {
          for (std::size_t j = i * piece; j < std::min(count, (i + 1) * piece); ++j)
            to[l][j] = l < d ? (points.data()[j * stride<d>(points) + l] - origin) * scale : 0;
        });
    std::fill(to[l].begin() + static_cast<std::ptrdiff_t>(count), to[l].end(), 0.0);
  }
}

}  // namespace

template <int d>
Engine<d>::Engine(Kernel kernel, const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Points<d>>* targets,
                  const Options& options)
    : options_(options) {
  check_options(kernel, options, d);
  check_points("source", sources.data(), d, static_cast<std::size_t>(sources.cols()), stride<d>(sources),
               options.threads);
  if (targets)
    check_points("target", targets->data(), d, static_cast<std::size_t>(targets->cols()), stride<d>(*targets),
                 options.threads);

  Box box;
  box.include<d>(sources);
  if (targets) box.include<d>(*targets);
  set_problem(kernel, box.exponent());
  problem_.self = targets == nullptr;
  problem_.sources = static_cast<std::size_t>(sources.cols());
  problem_.targets = targets ? static_cast<std::size_t>(targets->cols()) : problem_.sources;
  const double points = static_cast<double>(problem_.sources) + (targets ? static_cast<double>(problem_.targets) : 0.0);
  own_sources_ = problem_.sources;
  own_targets_ = problem_.targets;
  check_memory("the plan", 8.0 * points * problem_.dimension(), options.memory_limit);
  take<d>(sources, box, problem_.dimension(), exponent_, options.threads, problem_.source);
  if (targets) take<d>(*targets, box, problem_.dimension(), exponent_, options.threads, problem_.target);
  choice_.sources = problem_.sources;
  choice_.targets = problem_.targets;
  const auto choose = [&]<int dimension>(std::integral_constant<int, dimension>) {
    Site<dimension> site(problem_, options_);
    return choose_summation<dimension>(problem_, options_, site, choice_);
  };
  summation_ =
      problem_.dimension() == 3 ? choose(std::integral_constant<int, 3>()) : choose(std::integral_constant<int, 2>());
}

template <int d>
Engine<d>::Engine(Kernel kernel, const Eigen::Ref<const Points<d>>& points, std::span<const std::int64_t> numbers,
                  const Options& options, Ranks& ranks)
    : options_(options), channel_(ranks), numbers_(numbers.begin(), numbers.end()) {
  const std::size_t count = static_cast<std::size_t>(points.cols());
  together([&] {
    check_options(kernel, options, d);
    if (has_copies(options))
      throw InvalidArgument("farfield: Options::axes must be unbounded where points are on several ranks");
    if (numbers.size() != count)
      throw InvalidArgument("farfield: there are " + std::to_string(numbers.size()) + " numbers for " +
                            std::to_string(count) + " points; there must be one for every point");
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t l = 0; l < d; ++l)
        if (const double x = points.data()[j * stride<d>(points) + l]; !std::isfinite(x))
          throw InvalidArgument("farfield: coordinate " + std::to_string(l) + " of the point with the number " +
                                std::to_string(numbers[j]) + " is " + text(x) + "; coordinates must be finite");
  });
  Box box;
  box.include<d>(points);
  box.include_all(*channel_);
  set_problem(kernel, box.exponent());
  std::vector<std::int64_t> all{static_cast<std::int64_t>(count)};
  channel_->sum(all);
  own_sources_ = own_targets_ = count;
  problem_.sources = problem_.targets = static_cast<std::size_t>(all[0]);
  choice_.sources = choice_.targets = problem_.sources;
  together(
      [&] { check_memory("the plan", 8.0 * static_cast<double>(count) * problem_.dimension(), options.memory_limit); });
  take<d>(points, box, problem_.dimension(), exponent_, options.threads, problem_.source);
  const auto choose = [&]<int dimension>(std::integral_constant<int, dimension>) {
    SharedSite<dimension> site(problem_, options_, *channel_, numbers_, received_);
    return choose_summation<dimension>(problem_, options_, site, choice_);
  };
  summation_ =
      problem_.dimension() == 3 ? choose(std::integral_constant<int, 3>()) : choose(std::integral_constant<int, 2>());
}

template <int d>
void Engine<d>::set_problem(Kernel kernel, int exponent) {
  exponent_ = exponent;
  problem_.interaction = kernel == Kernel::vortex_blob         ? Interaction::blob
                         : kernel == Kernel::coulomb && d == 3 ? Interaction::inverse
                                                               : Interaction::logarithm;
  problem_.potential = options_.potential && kernel != Kernel::vortex_blob;
  problem_.log_shift = exponent_ * std::numbers::ln2;
  if (kernel == Kernel::vortex_blob) {
    const double core = std::ldexp(options_.core_radius, -exponent_);
    problem_.inverse_squared_core = std::min(1 / core / core, std::numeric_limits<double>::max());
  }
  choice_.kernel = kernel;
  choice_.method = Method::direct;
  choice_.tolerance = options_.tolerance;
}

template <int d>
template <class Work>
void Engine<d>::together(const Work& work) const {
  if (channel_) {
    channel_->together(work);
  } else {
    work();
  }
}

template <int d>
void Engine<d>::check_results(const char* what, const double* values, std::size_t count,
                              std::size_t numbers_a_target) const {
  together([&] { check_values(what, values, count, numbers_a_target, numbers_.empty() ? nullptr : numbers_.data()); });
}

template <int d>
Values<d> Engine<d>::evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds& seconds) const {
  const std::size_t sources = own_sources_, targets = own_targets_,
                    outputs = static_cast<std::size_t>(problem_.dimension() + problem_.potential);
  together([&] {
    check_charges(charges, sources);
    check_memory("the evaluation",
                 8.0 * static_cast<double>(sources) + 16.0 * static_cast<double>(targets * outputs) +
                     summation_->evaluation_bytes(),
                 options_.memory_limit);
  });

  double largest = sources > 0 ? charges.cwiseAbs().maxCoeff() : 0.0;
  if (channel_) {
    std::vector<double> of_all{largest};
    channel_->max(of_all);
    largest = of_all[0];
  }
  const int charge_exponent =
      largest > 0 ? std::clamp(std::ilogb(largest) + 1, -largest_exponent, largest_exponent) : 0;
  const double charge_scale = std::ldexp(1.0, -charge_exponent);
  Buffer<double> scaled(sources + padding);
  std::fill(scaled.begin(), scaled.end(), 0.0);
  for (std::size_t j = 0; j < sources; ++j) scaled[j] = charges.data()[j] * charge_scale;

  Sums sums;
  if (problem_.potential) sums.potential.assign(targets + padding, 0.0);
  for (std::size_t l = 0; l < static_cast<std::size_t>(problem_.dimension()); ++l)
    sums.field[l].assign(targets + padding, 0.0);
  summation_->evaluate(scaled, sums, seconds);

  // Back to the caller's units: 1/r and 1/r^2 in 3D; ln r, which knows its unit already, and 1/r in 1D and 2D.
  const bool inverse = problem_.interaction == Interaction::inverse;
  const auto in_units = [&](double value, int lengths) {
    return std::ldexp(std::ldexp(value, charge_exponent), -lengths * exponent_);
  };
  const double sign = choice_.kernel == Kernel::coulomb && !inverse ? -1.0 : 1.0;
  Values<d> values;
  values.field.resize(d, static_cast<Eigen::Index>(targets));
  if (problem_.potential) {
    values.potential.resize(static_cast<Eigen::Index>(targets));
    for (std::size_t i = 0; i < targets; ++i)
      values.potential.data()[i] = sign * in_units(sums.potential[i], inverse ? 1 : 0);
    check_results("potential", values.potential.data(), targets, 1);
  }
  for (std::size_t i = 0; i < targets; ++i) {
    double* const field = values.field.data() + i * d;
    if (choice_.kernel == Kernel::vortex_blob) {
      field[0] = in_units(-sums.field[1][i] / (2 * std::numbers::pi), 1);
      if constexpr (d > 1) field[1] = in_units(sums.field[0][i] / (2 * std::numbers::pi), 1);
    } else {
      for (std::size_t l = 0; l < d; ++l) field[l] = in_units(sums.field[l][i], inverse ? 2 : 1);
    }
  }
  check_results("field", values.field.data(), targets, d);
  return values;
}

template class Engine<1>;
template class Engine<2>;
template class Engine<3>;

}  // namespace farfield::detail
