// What the tests of fgtd compare with: the definition term by term in long double, and points to try it on.
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "fgtd/fgtd.hpp"

namespace naive {

/// Reproducible numbers in [0, 1) (splitmix64); the standard distributions differ between libraries.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double operator()() {
    state_ += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-53;
  }

 private:
  std::uint64_t state_;
};

template <int d>
fgtd::Points<d> random_points(int count, std::uint64_t seed, double low = 0, double high = 1) {
  Random random(seed);
  fgtd::Points<d> points(d, count);
  for (int j = 0; j < count; ++j)
    for (int l = 0; l < d; ++l) points(l, j) = low + (high - low) * random();
  return points;
}

inline Eigen::MatrixXd random_weights(int count, int columns, std::uint64_t seed) {
  Random random(seed);
  Eigen::MatrixXd weights(count, columns);
  for (int k = 0; k < columns; ++k)
    for (int j = 0; j < count; ++j) weights(j, k) = 2 * random() - 1;
  return weights;
}

/// [Sch06, Algorithm 4.1]
inline double halton(int n, int base) {
  double value = 0, digit = 1.0 / base;
  for (; n > 0; n /= base, digit /= base) value += (n % base) * digit;
  return value;
}

inline std::vector<double> nodes(int count, double low, double high) {
  std::vector<double> list;
  for (int i = 0; i < count; ++i) list.push_back(low + (high - low) * i / std::max(1, count - 1));
  return list;
}

template <int d>
fgtd::TensorGrid cube_grid(int count, double low, double high) {
  return {std::vector<std::vector<double>>(d, nodes(count, low, high))};
}

/// The grid's points one by one, first axis fastest.
template <int d>
fgtd::Points<d> points_of(const fgtd::TensorGrid& grid) {
  fgtd::Points<d> points(d, static_cast<Eigen::Index>(grid.size()));
  for (std::size_t i = 0; i < grid.size(); ++i) {
    std::size_t rest = i;
    for (std::size_t l = 0; l < d; ++l) {
      points(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(i)) = grid.axes[l][rest % grid.axes[l].size()];
      rest /= grid.axes[l].size();
    }
  }
  return points;
}

/// H_n(t) e^{-t^2}
inline long double hermite_function(int n, long double t) {
  long double before = 0, now = std::exp(-t * t);
  for (int m = 0; m < n; ++m) {
    const long double next = 2 * t * now - 2 * m * before;
    before = now;
    now = next;
  }
  return now;
}

/// D^alpha exp(-sigma |y - x|^2) = (-sqrt(sigma))^|alpha| h_alpha(sqrt(sigma) (y - x))
template <int d>
long double term(const Eigen::Matrix<double, d, 1>& y, const Eigen::Matrix<double, d, 1>& x, double sigma,
                 const fgtd::Derivative<d>& alpha) {
  const long double root = std::sqrt(static_cast<long double>(sigma));
  long double product = 1;
  for (int l = 0; l < d; ++l) {
    const int a = alpha[static_cast<std::size_t>(l)];
    product *= hermite_function(a, root * (static_cast<long double>(y[l]) - x[l])) * std::pow(-root, a);
  }
  return product;
}

template <int d>
Eigen::MatrixXd sum(const fgtd::Points<d>& sources, const Eigen::MatrixXd& weights, double sigma,
                    const fgtd::Points<d>& targets, const fgtd::Derivative<d>& alpha = {}) {
  Eigen::MatrixXd values(targets.cols(), weights.cols());
  for (Eigen::Index i = 0; i < targets.cols(); ++i)
    for (Eigen::Index k = 0; k < weights.cols(); ++k) {
      long double total = 0;
      for (Eigen::Index j = 0; j < sources.cols(); ++j)
        total += weights(j, k) * term<d>(targets.col(i), sources.col(j), sigma, alpha);
      values(i, k) = static_cast<double>(total);
    }
  return values;
}

/// All alpha with |alpha| = order.
template <int d>
std::vector<fgtd::Derivative<d>> derivatives_of_order(int order) {
  std::vector<fgtd::Derivative<d>> list;
  const auto fill = [&](const auto& self, fgtd::Derivative<d> alpha, std::size_t axis, int left) -> void {
    if (axis + 1 == d) {
      alpha[axis] = left;
      list.push_back(alpha);
      return;
    }
    for (int a = 0; a <= left; ++a) {
      alpha[axis] = a;
      self(self, alpha, axis + 1, left - a);
    }
  };
  fill(fill, {}, 0, order);
  return list;
}

template <int d>
fgtd::Combination<d> laplacian() {
  fgtd::Combination<d> combination;
  for (std::size_t l = 0; l < d; ++l) {
    fgtd::Term<d> second;
    second.derivative[l] = 2;
    combination.push_back(second);
  }
  return combination;
}

template <int d>
std::vector<fgtd::Combination<d>> value_and_gradient() {
  std::vector<fgtd::Combination<d>> list{{fgtd::Term<d>{}}};
  for (std::size_t l = 0; l < d; ++l) {
    fgtd::Term<d> first;
    first.derivative[l] = 1;
    list.push_back({first});
  }
  return list;
}

/// `Dimension<d>::value`: for tests over all dimensions.
template <int d>
struct Dimension {
  static constexpr int value = d;
};

}  // namespace naive
