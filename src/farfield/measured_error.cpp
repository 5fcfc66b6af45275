#include "farfield/measured_error.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <random>

namespace farfield::detail {
namespace {

template <int d>
using Point = std::array<double, d>;

/// Corners, middles of edges and faces, then points at random on edges, on faces and inside.
template <int d>
std::vector<Point<d>> samples_of_cube(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::vector<Point<d>> points;
  int grid = 1;
  for (int l = 0; l < d; ++l) grid *= 3;
  for (int number = 0; number < grid; ++number) {
    Point<d> point;
    int rest = number;
    for (double& x : point) {
      x = (rest % 3 - 1) / 2.0;
      rest /= 3;
    }
    points.push_back(point);
  }
  while (static_cast<int>(points.size()) < count) {
    Point<d> point;
    for (double& x : point) x = static_cast<double>(random()) * 0x1p-32 - 0.5;
    const std::size_t fixed = points.size() % d;  // axes at an end
    for (std::size_t l = 0; l < fixed; ++l) {
      const std::size_t axis = (points.size() / d + l) % d;
      point[axis] = point[axis] < 0 ? -0.5 : 0.5;
    }
    points.push_back(point);
  }
  return points;
}

template <int d>
double distance(const Point<d>& x, const Point<d>& y, Point<d>& difference) {
  double squared = 0;
  for (std::size_t l = 0; l < d; ++l) {
    difference[l] = x[l] - y[l];
    squared += difference[l] * difference[l];
  }
  return std::sqrt(squared);
}

/// Of potential and gradient of g at distance r.
template <int d>
double relative_error(double potential, const Point<d>& gradient, const Point<d>& difference, double r) {
  const double exact = d == 3 ? 1 / r : std::log(r), slope = d == 3 ? -1 / (r * r * r) : 1 / (r * r);
  double squared = 0;
  for (std::size_t l = 0; l < d; ++l) squared += std::pow(gradient[l] - slope * difference[l], 2);
  return std::max(std::abs(potential - exact) * (d == 3 ? r : 1), std::sqrt(squared) * (d == 3 ? r * r : r));
}

template <int d>
std::vector<double> harmonics_at(int degree, const Point<d>& point) {
  Point<d> t;
  for (std::size_t l = 0; l < d; ++l) t[l] = stretch * point[l];
  std::vector<double> values(functions<d>(degree));
  evaluate_harmonics<d>(degree, t.data(), values.data());
  return values;
}

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += a[k] * b[k];
  return sum;
}

/// Largest error at the targets (k away) of the expansion of one charge at y.
template <int d>
double error_of_expansion(int degree, const std::vector<double>& coefficients, const std::vector<Point<d>>& targets,
                          const std::vector<std::vector<double>>& values, const int* k, const Point<d>& y) {
  std::vector<double> slope[d];
  double* pointers[d];
  for (int l = 0; l < d; ++l) {
    slope[l].resize(coefficients.size());
    pointers[l] = slope[l].data();
  }
  differentiate<d>(degree, coefficients.data(), pointers);
  double worst = 0;
  for (std::size_t i = 0; i < targets.size(); ++i) {
    Point<d> gradient, x = targets[i], difference;
    for (std::size_t l = 0; l < d; ++l) {
      gradient[l] = stretch * dot(slope[l], values[i]);
      x[l] += k[l];
    }
    const double r = distance<d>(x, y, difference);
    worst = std::max(worst, relative_error<d>(dot(coefficients, values[i]), gradient, difference, r));
  }
  return worst;
}

}  // namespace

template <>
std::vector<std::array<int, 3>> offset_classes<2>() {
  std::vector<std::array<int, 3>> classes;
  for (int a = 2; a <= farthest; ++a)
    for (int b = 0; b <= a; ++b) classes.push_back({a, b, 0});
  return classes;
}

template <>
std::vector<std::array<int, 3>> offset_classes<3>() {
  std::vector<std::array<int, 3>> classes;
  for (int a = 2; a <= farthest; ++a)
    for (int b = 0; b <= a; ++b)
      for (int c = 0; c <= b; ++c) classes.push_back({a, b, c});
  return classes;
}

template <int d>
double measure_pair_error(const Interpolation<d>& interpolation, const int* k, int samples, unsigned seed) {
  const Coupling coupling = make_coupling<d>(interpolation, k);
  const auto sources = samples_of_cube<d>(samples, seed), targets = samples_of_cube<d>(samples, seed + 1);
  std::vector<std::vector<double>> values;
  for (const auto& x : targets) values.push_back(harmonics_at<d>(interpolation.degree(), x));
  double worst = 0;
  for (const auto& y : sources) {
    const std::vector<double> moments = harmonics_at<d>(interpolation.degree(), y);
    std::vector<double> coefficients(moments.size());
    for (const auto& block : coupling.blocks) {
      const std::size_t size = block.functions.size();
      for (std::size_t b = 0; b < size; ++b)
        for (std::size_t a = 0; a < size; ++a)
          coefficients[block.functions[a]] += block.matrix[b * size + a] * moments[block.functions[b]];
    }
    worst = std::max(worst, error_of_expansion<d>(interpolation.degree(), coefficients, targets, values, k, y));
  }
  return worst;
}

// By symmetry the error of interpolated targets in the field of one charge; the field's is the larger one there, since
// differentiating the interpolant costs accuracy that the kernel's own derivative does not.
template <int d>
double measure_one_sided_error(const Interpolation<d>& interpolation, int samples, unsigned seed) {
  const auto targets = samples_of_cube<d>(samples, seed), around = samples_of_cube<d>(samples, seed + 1);
  std::vector<std::vector<double>> values;
  for (const auto& x : targets) values.push_back(harmonics_at<d>(interpolation.degree(), x));
  const int k[3] = {};
  double worst = 0;
  for (Point<d> y : around) {
    // at distance 1 from the cube: onto the surface of a cube three times as large, nearest points included
    double largest = 0;
    for (const double x : y) largest = std::max(largest, std::abs(x));
    if (largest == 0) continue;
    for (double& x : y) x *= 1.5 / largest;
    std::vector<double> at_nodes(interpolation.nodes()), coefficients(functions<d>(interpolation.degree()));
    for (std::size_t s = 0; s < Interpolation<d>::reflections; ++s)
      for (std::size_t i = 0; i < interpolation.octant(); ++i) {
        Point<d> x, difference;
        for (std::size_t l = 0; l < d; ++l) x[l] = interpolation.node(s, i, l);
        const double r = distance<d>(x, y, difference);
        at_nodes[s * interpolation.octant() + i] = d == 3 ? 1 / r : std::log(r);
      }
    interpolation.fit(at_nodes.data(), coefficients.data());
    worst = std::max(worst, error_of_expansion<d>(interpolation.degree(), coefficients, targets, values, k, y));
  }
  return worst;
}

template double measure_pair_error<2>(const Interpolation<2>&, const int*, int, unsigned);
template double measure_pair_error<3>(const Interpolation<3>&, const int*, int, unsigned);
template double measure_one_sided_error<2>(const Interpolation<2>&, int, unsigned);
template double measure_one_sided_error<3>(const Interpolation<3>&, int, unsigned);

}  // namespace farfield::detail
