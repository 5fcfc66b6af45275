// The sums of farfield by their definition, in long double, with the sums that the promise is relative to.
#pragma once

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "farfield/farfield.hpp"

namespace naive {

using farfield::Kernel;
using farfield::Points;

/// potential and field, and per target what errors are relative to (farfield.hpp, Plan)
template <int d>
struct Sums {
  Eigen::VectorXd potential, potential_scale, field_scale;
  Points<d> field;
};

template <int d>
Sums<d> sum(Kernel kernel, const Points<d>& sources, const Points<d>& targets, const Eigen::VectorXd& charges,
            double core_radius = 0) {
  const Eigen::Index count = targets.cols();
  Sums<d> sums{Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count), Eigen::VectorXd::Zero(count),
               Points<d>::Zero(d, count)};
  for (Eigen::Index i = 0; i < count; ++i) {
    long double potential = 0, potential_scale = 0, field_scale = 0, field[d] = {};
    for (Eigen::Index j = 0; j < sources.cols(); ++j) {
      long double distance[d], squared = 0;
      for (int l = 0; l < d; ++l) {
        distance[l] = static_cast<long double>(targets(l, i)) - static_cast<long double>(sources(l, j));
        squared += distance[l] * distance[l];
      }
      if (squared == 0) continue;
      const long double r = std::sqrt(squared), q = charges[j];
      const long double weight = std::abs(q), around = 6.283185307179586476925286766559L;
      if (kernel == Kernel::vortex_blob) {
        const long double s = squared / (static_cast<long double>(core_radius) * core_radius);
        const long double factor = -q * std::expm1(-s) / (around * squared);
        if constexpr (d == 2) {
          field[0] -= factor * distance[1];
          field[1] += factor * distance[0];
        }
        field_scale += weight / (around * r);
        continue;
      }
      const bool three = d == 3, coulomb = kernel == Kernel::coulomb;
      potential += three ? q / r : coulomb ? -q * std::log(r) : q * std::log(r);
      potential_scale += three ? weight / r : weight * (1 + std::abs(std::log(r)));
      const long double strength = three ? 1 / (squared * r) : 1 / squared;
      for (int l = 0; l < d; ++l) field[l] += q * strength * distance[l];
      field_scale += weight * strength * r;
    }
    sums.potential[i] = static_cast<double>(potential);
    sums.potential_scale[i] = static_cast<double>(potential_scale);
    sums.field_scale[i] = static_cast<double>(field_scale);
    for (int l = 0; l < d; ++l) sums.field(l, i) = static_cast<double>(field[l]);
  }
  return sums;
}

/// Errors relative to what the promise is relative to; 0 where both are 0.
struct Errors {
  double potential = 0, field = 0;
};

template <int d>
Errors errors(const farfield::Values<d>& values, const Sums<d>& exact) {
  const auto ratio = [](double error, double scale) { return error == 0 ? 0.0 : error / scale; };
  Errors errors;
  if (values.potential.size() > 0)
    errors.potential = ratio((values.potential - exact.potential).stableNorm(), exact.potential_scale.stableNorm());
  errors.field =
      ratio(Eigen::VectorXd((values.field - exact.field).reshaped()).stableNorm(), exact.field_scale.stableNorm());
  return errors;
}

// ---------------------------------------------------------------------------------------------------------------
// Points

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// The engine is the same everywhere; the distributions of the standard library are not.
  double in(double low, double high) { return low + (high - low) * (static_cast<double>(engine_()) * 0x1p-32); }

 private:
  std::mt19937 engine_;
};

template <int d>
Points<d> cube(Eigen::Index count, unsigned seed, double low = 0, double high = 1) {
  Random random(seed);
  Points<d> points(d, count);
  for (Eigen::Index j = 0; j < count; ++j)
    for (int l = 0; l < d; ++l) points(l, j) = random.in(low, high);
  return points;
}

/// Plummer's sphere of scale 1, cut at 20: density (1 + r^2)^(-5/2); in fewer dimensions its projection.
template <int d>
Points<d> plummer(Eigen::Index count, unsigned seed) {
  Random random(seed);
  Points<d> points(d, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    double radius;
    do radius = 1 / std::sqrt(std::pow(random.in(1e-9, 1), -2.0 / 3) - 1);
    while (!(radius < 20));
    const double height = random.in(-1, 1), angle = random.in(0, 2 * 3.14159265358979323846);
    const double direction[3] = {std::sqrt(1 - height * height) * std::cos(angle),
                                 std::sqrt(1 - height * height) * std::sin(angle), height};
    for (int l = 0; l < d; ++l) points(l, j) = radius * direction[l];
  }
  return points;
}

inline Eigen::VectorXd charges(Eigen::Index count, unsigned seed, double low = -1, double high = 1) {
  Random random(seed);
  Eigen::VectorXd result(count);
  for (Eigen::Index j = 0; j < count; ++j) result[j] = random.in(low, high);
  return result;
}

}  // namespace naive
