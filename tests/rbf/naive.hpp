// The definition, in long double, and points to try it on.
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "rbf/rbf.hpp"

namespace naive {

/// phi(r) as the header writes it.
inline long double phi(const rbf::Function& function, long double r) {
  const long double c = function.shape;
  switch (function.kernel) {
    case rbf::Kernel::gaussian:
      return std::exp(-r * r / (c * c));
    case rbf::Kernel::multiquadric:
      return std::sqrt(r * r + c * c);
    case rbf::Kernel::inverse_multiquadric:
      return 1 / std::sqrt(r * r + c * c);
    case rbf::Kernel::inverse_quadratic:
      return 1 / (r * r + c * c);
    case rbf::Kernel::thin_plate:
      return r > 0 ? r * r * std::log(r) : 0;
    case rbf::Kernel::matern32: {
      const long double a = std::sqrt(3.0L) * r / c;
      return (1 + a) * std::exp(-a);
    }
    case rbf::Kernel::matern52: {
      const long double a = std::sqrt(5.0L) * r / c;
      return (1 + a + a * a / 3) * std::exp(-a);
    }
  }
  return 0;
}

/// phi'(r) and phi'(r)/r and phi''(r), by formula; at r = 0 their limits (thin-plate has none of the last two).
struct Slopes {
  long double first = 0, over_r = 0, second = 0;
};
inline Slopes slopes(const rbf::Function& function, long double r) {
  const long double c = function.shape, q = r * r + c * c;
  switch (function.kernel) {
    case rbf::Kernel::gaussian: {
      const long double f = std::exp(-r * r / (c * c)), t = 1 / (c * c);
      return {-2 * t * r * f, -2 * t * f, (4 * t * t * r * r - 2 * t) * f};
    }
    case rbf::Kernel::multiquadric:
      return {r / std::sqrt(q), 1 / std::sqrt(q), c * c / (q * std::sqrt(q))};
    case rbf::Kernel::inverse_multiquadric:
      return {-r / (q * std::sqrt(q)), -1 / (q * std::sqrt(q)), (2 * r * r - c * c) / (q * q * std::sqrt(q))};
    case rbf::Kernel::inverse_quadratic:
      return {-2 * r / (q * q), -2 / (q * q), (6 * r * r - 2 * c * c) / (q * q * q)};
    case rbf::Kernel::thin_plate:
      return {r > 0 ? r * (2 * std::log(r) + 1) : 0, 0, 0};
    case rbf::Kernel::matern32: {
      const long double k = std::sqrt(3.0L) / c, e = std::exp(-k * r);
      return {-k * k * r * e, -k * k * e, -k * k * (1 - k * r) * e};
    }
    case rbf::Kernel::matern52: {
      const long double k = std::sqrt(5.0L) / c, a = k * r, e = std::exp(-a);
      return {-k * k * r * (1 + a) * e / 3, -k * k * (1 + a) * e / 3, -k * k * (1 + a - a * a) * e / 3};
    }
  }
  return {};
}

/// What the promises are relative to: the largest of phi, phi', and phi'' or phi'/r up to `range`.
struct Scales {
  long double value = 0, first = 0, second = 0;
};
inline Scales scales(const rbf::Function& function, double range) {
  Scales found;
  for (int i = 0; i <= 4000; ++i) {
    const long double r = i == 0 ? 0 : range * std::pow(10.0L, -8 + 8 * static_cast<long double>(i) / 4000);
    const Slopes at = slopes(function, r);
    found.value = std::max(found.value, std::abs(phi(function, r)));
    found.first = std::max(found.first, std::abs(at.first));
    found.second = std::max({found.second, std::abs(at.over_r), std::abs(at.second)});
  }
  return found;
}

/// D^alpha of the sum at one target, |alpha| <= 2.
template <int d>
long double sum(const rbf::Function& function, const rbf::Points<d>& centres, const Eigen::VectorXd& weights,
                const Eigen::Matrix<double, d, 1>& target, const rbf::Derivative<d>& alpha) {
  std::vector<int> axes;
  for (int l = 0; l < d; ++l)
    for (int i = 0; i < alpha[static_cast<std::size_t>(l)]; ++i) axes.push_back(l);
  long double total = 0;
  for (Eigen::Index j = 0; j < centres.cols(); ++j) {
    long double apart[d], squared = 0;
    for (int l = 0; l < d; ++l) {
      apart[l] = static_cast<long double>(target[l]) - centres(l, j);
      squared += apart[l] * apart[l];
    }
    const long double r = std::sqrt(squared);
    long double value = phi(function, r);
    if (!axes.empty()) {
      const Slopes at = slopes(function, r);
      if (axes.size() == 1) value = r > 0 ? at.first * apart[axes[0]] / r : 0;
      if (axes.size() == 2) {
        value = r > 0 ? (at.second - at.over_r) * (apart[axes[0]] / r) * (apart[axes[1]] / r) : 0;
        if (axes[0] == axes[1]) value += at.over_r;
      }
    }
    total += weights[j] * value;
  }
  return total;
}

/// Numbers in [-1, 1], the same everywhere.
inline Eigen::MatrixXd numbers(Eigen::Index rows, Eigen::Index columns, unsigned seed) {
  std::mt19937 random(seed);
  Eigen::MatrixXd found(rows, columns);
  for (double& x : found.reshaped()) x = 2 * (static_cast<double>(random()) * 0x1p-32) - 1;
  return found;
}

/// Points in the unit cube.
template <int d>
rbf::Points<d> cube(Eigen::Index count, unsigned seed) {
  return (0.5 * (numbers(d, count, seed).array() + 1)).matrix();
}

template <int d>
struct Cloud {
  std::string name;
  rbf::Points<d> points;
};

/// Points that are hard for boxes, cells and a near field.
template <int d>
std::vector<Cloud<d>> clouds(Eigen::Index count, unsigned seed) {
  const rbf::Points<d> even = numbers(d, count, seed);
  rbf::Points<d> clustered = even, equal = even;
  for (Eigen::Index j = 0; j < count; ++j) {
    if (j % 3 == 1) clustered.col(j) = 0.7 * rbf::Points<d>::Ones(d, 1) + 1e-3 * even.col(j);
    if (j % 3 == 2) clustered.col(j) = -0.4 * rbf::Points<d>::Ones(d, 1) + 1e-7 * even.col(j);
    equal.col(j) = even.col(j % 7);
  }
  return {{"even", even},
          {"clustered", clustered},
          {"seven points, each many times", equal},
          {"far from the origin", (even.array() + 1e6).matrix()}};
}

inline std::vector<rbf::Function> functions() {
  std::vector<rbf::Function> all;
  for (const rbf::Kernel kernel : rbf::kernels()) all.push_back({kernel, rbf::takes_shape(kernel) ? 0.3 : 0});
  return all;
}

inline std::string name(const rbf::Function& function) {
  std::string name = rbf::to_string(function.kernel);
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

}  // namespace naive
