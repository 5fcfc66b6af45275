#include "farfield/interpolation/measured_error.hpp"

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

/// Errors of potential and gradient of g at distance r.
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

/// The field of one charge at y, expanded around the cluster of targets, k away.
template <int d>
class Expansion {
 public:
  Expansion(int degree, std::vector<double> coefficients, const int* k, const Point<d>& y)
      : degree_(degree), coefficients_(std::move(coefficients)), k_(k), y_(y) {
    double* pointers[d];
    for (int l = 0; l < d; ++l) {
      slope_[l].resize(coefficients_.size());
      pointers[l] = slope_[l].data();
    }
    differentiate<d>(degree_, coefficients_.data(), pointers);
  }

  /// At the target x, whose harmonics are `values`.
  double error(Point<d> x, const std::vector<double>& values) const {
    Point<d> gradient, difference;
    for (std::size_t l = 0; l < d; ++l) {
      gradient[l] = stretch * dot(slope_[l], values);
      x[l] += k_[l];
    }
    const double r = distance<d>(x, y_, difference);
    return relative_error<d>(dot(coefficients_, values), gradient, difference, r);
  }
  double error(const Point<d>& x) const { return error(x, harmonics_at<d>(degree_, x)); }

 private:
  int degree_;
  std::vector<double> coefficients_, slope_[d];
  const int* k_;
  Point<d> y_;
};

template <int d>
Expansion<d> coupled(const Coupling& coupling, const int* k, const Point<d>& y) {
  const std::vector<double> moments = harmonics_at<d>(coupling.degree, y);
  std::vector<double> coefficients(moments.size());
  for (const auto& block : coupling.blocks) {
    const std::size_t size = block.functions.size();
    for (std::size_t b = 0; b < size; ++b)
      for (std::size_t a = 0; a < size; ++a)
        coefficients[block.functions[a]] += block.matrix[b * size + a] * moments[block.functions[b]];
  }
  return {coupling.degree, std::move(coefficients), k, y};
}

/// The potential of a charge at y fitted in the cube around the origin.
template <int d>
Expansion<d> fitted(const Interpolation<d>& interpolation, const Point<d>& y) {
  static constexpr int here[3] = {};
  std::vector<double> at_nodes(interpolation.nodes()), coefficients(functions<d>(interpolation.degree()));
  for (std::size_t s = 0; s < Interpolation<d>::reflections; ++s)
    for (std::size_t i = 0; i < interpolation.octant(); ++i) {
      Point<d> x, difference;
      for (std::size_t l = 0; l < d; ++l) x[l] = interpolation.node(s, i, l);
      const double r = distance<d>(x, y, difference);
      at_nodes[s * interpolation.octant() + i] = d == 3 ? 1 / r : std::log(r);
    }
  interpolation.fit(at_nodes.data(), coefficients.data());
  return {interpolation.degree(), std::move(coefficients), here, y};
}

/// Onto the surface of a cube three times as large: at distance 1 from the cube, nearest points included.
template <int d>
Point<d> around_cube(Point<d> y) {
  double largest = 0;
  for (const double x : y) largest = std::max(largest, std::abs(x));
  for (double& x : y) x *= largest > 0 ? 1.5 / largest : 0;
  if (largest == 0) y[0] = 1.5;
  return y;
}

/// Largest error over sources y and targets x in the unit cube; expansion(y) makes that of a source. The search starts
/// at samples and climbs from the worst of them: one coordinate after the other, by steps that are halved.
template <int d, class Make>
double largest_error(int degree, int samples, unsigned seed, bool climb, const Make& expansion) {
  const auto sources = samples_of_cube<d>(samples, seed), targets = samples_of_cube<d>(samples, seed + 1);
  std::vector<std::vector<double>> values;
  for (const auto& x : targets) values.push_back(harmonics_at<d>(degree, x));
  struct Start {
    double error;
    Point<d> x, y;
  };
  std::vector<Start> starts;
  for (const auto& y : sources) {
    const Expansion<d> expanded = expansion(y);
    Start worst{-1, {}, y};
    for (std::size_t i = 0; i < targets.size(); ++i) {
      const double error = expanded.error(targets[i], values[i]);
      if (error > worst.error) worst = {error, targets[i], y};
    }
    starts.push_back(worst);
  }
  std::sort(starts.begin(), starts.end(), [](const Start& a, const Start& b) { return a.error > b.error; });
  double largest = starts.front().error;
  if (!climb) return largest;
  starts.resize(std::min<std::size_t>(starts.size(), 4));
  for (Start& at : starts) {
    for (double step = 0.1; step > 0.004; step /= 2)
      for (bool moved = true; moved;) {
        moved = false;
        for (int l = 0; l < 2 * d; ++l)
          for (const double sign : {-1.0, 1.0}) {
            Start next = at;
            double& moving = l < d ? next.x[static_cast<std::size_t>(l)] : next.y[static_cast<std::size_t>(l - d)];
            moving = std::clamp(moving + sign * step, -0.5, 0.5);
            next.error = expansion(next.y).error(next.x);
            if (!(next.error > at.error * 1.0001)) continue;
            at = next;
            moved = true;
          }
      }
    largest = std::max(largest, at.error);
  }
  return largest;
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
double measure_pair_error(const Interpolation<d>& interpolation, const int* k, int samples, unsigned seed, bool climb) {
  const Coupling coupling = make_coupling<d>(interpolation, k);
  return largest_error<d>(interpolation.degree(), samples, seed, climb,
                          [&](const Point<d>& y) { return coupled<d>(coupling, k, y); });
}

// By symmetry this is the error of interpolated targets in the field of one charge. The error of the field is the
// larger one, because differentiating the interpolant costs accuracy; the kernel's own derivative does not.
template <int d>
double measure_one_sided_error(const Interpolation<d>& interpolation, int samples, unsigned seed, bool climb) {
  return largest_error<d>(interpolation.degree(), samples, seed, climb,
                          [&](const Point<d>& y) { return fitted<d>(interpolation, around_cube<d>(y)); });
}

template double measure_pair_error<2>(const Interpolation<2>&, const int*, int, unsigned, bool);
template double measure_pair_error<3>(const Interpolation<3>&, const int*, int, unsigned, bool);
template double measure_one_sided_error<2>(const Interpolation<2>&, int, unsigned, bool);
template double measure_one_sided_error<3>(const Interpolation<3>&, int, unsigned, bool);

}  // namespace farfield::detail
