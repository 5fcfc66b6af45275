#include "farfield/engine.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "farfield/check.hpp"
#include "farfield/choose.hpp"

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
  exponent_ = box.exponent();

  problem_.interaction = kernel == Kernel::vortex_blob         ? Interaction::blob
                         : kernel == Kernel::coulomb && d == 3 ? Interaction::inverse
                                                               : Interaction::logarithm;
  problem_.potential = options.potential && kernel != Kernel::vortex_blob;
  problem_.log_shift = exponent_ * std::numbers::ln2;
  if (kernel == Kernel::vortex_blob) {
    const double core = std::ldexp(options.core_radius, -exponent_);
    problem_.inverse_squared_core = std::min(1 / core / core, std::numeric_limits<double>::max());
  }
  problem_.self = targets == nullptr;
  problem_.sources = static_cast<std::size_t>(sources.cols());
  problem_.targets = targets ? static_cast<std::size_t>(targets->cols()) : problem_.sources;
  const double points = static_cast<double>(problem_.sources) + (targets ? static_cast<double>(problem_.targets) : 0.0);
  check_memory("the plan", 8.0 * points * problem_.dimension(), options.memory_limit);
  take<d>(sources, box, problem_.dimension(), exponent_, options.threads, problem_.source);
  if (targets) take<d>(*targets, box, problem_.dimension(), exponent_, options.threads, problem_.target);

  choice_.kernel = kernel;
  choice_.method = Method::direct;
  choice_.tolerance = options.tolerance;
  choice_.sources = problem_.sources;
  choice_.targets = problem_.targets;
  summation_ = problem_.dimension() == 3 ? choose_summation<3>(problem_, options_, choice_)
                                         : choose_summation<2>(problem_, options_, choice_);
}

template <int d>
Values<d> Engine<d>::evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds& seconds) const {
  check_charges(charges, problem_.sources);
  const std::size_t targets = problem_.targets,
                    outputs = static_cast<std::size_t>(problem_.dimension() + problem_.potential);
  check_memory("the evaluation",
               8.0 * static_cast<double>(problem_.sources) + 16.0 * static_cast<double>(targets * outputs) +
                   summation_->evaluation_bytes(),
               options_.memory_limit);

  const double largest = problem_.sources > 0 ? charges.cwiseAbs().maxCoeff() : 0.0;
  const int charge_exponent =
      largest > 0 ? std::clamp(std::ilogb(largest) + 1, -largest_exponent, largest_exponent) : 0;
  const double charge_scale = std::ldexp(1.0, -charge_exponent);
  Buffer<double> scaled(problem_.sources + padding);
  std::fill(scaled.begin(), scaled.end(), 0.0);
  for (std::size_t j = 0; j < problem_.sources; ++j) scaled[j] = charges.data()[j] * charge_scale;

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
    check_values("potential", values.potential.data(), targets, 1);
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
  check_values("field", values.field.data(), targets, d);
  return values;
}

template class Engine<1>;
template class Engine<2>;
template class Engine<3>;

}  // namespace farfield::detail
