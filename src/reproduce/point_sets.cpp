#include "reproduce/point_sets.hpp"

#include <random>

namespace gaussdrift::reproduce {

namespace {

using Index = Eigen::Index;

// In [0, 1). The distributions of the standard library differ between libraries, its generators do not.
class Uniform {
 public:
  explicit Uniform(std::uint64_t seed) : generator_(seed) {}
  double operator()() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

 private:
  std::mt19937_64 generator_;
};

}  // namespace

double halton(std::size_t n, int base) {
  const auto b = static_cast<std::size_t>(base);
  double value = 0, digit = 1.0 / base;
  for (; n > 0; n /= b, digit /= base) value += static_cast<double>(n % b) * digit;
  return value;
}

template <int d>
fgtd::Points<d> halton_points(std::size_t count) {
  fgtd::Points<d> points(d, static_cast<Index>(count));
  for (std::size_t j = 0; j < count; ++j)
    for (int l = 0; l < d; ++l) points(l, static_cast<Index>(j)) = halton(j, primes[l]);
  return points;
}

Eigen::MatrixXd halton_weights(std::size_t count, int d) {
  Eigen::MatrixXd weights(static_cast<Index>(count), 1);
  for (std::size_t j = 0; j < count; ++j) weights(static_cast<Index>(j), 0) = halton(j, primes[d]);
  return weights;
}

template <int d>
fgtd::Points<d> random_points(std::size_t count, std::uint64_t seed) {
  Uniform uniform(seed);
  fgtd::Points<d> points(d, static_cast<Index>(count));
  for (Index j = 0; j < points.cols(); ++j)
    for (int l = 0; l < d; ++l) points(l, j) = uniform();
  return points;
}

template <int d>
fgtd::Points<d> clustered_points(std::size_t count, std::size_t clusters, double side, std::uint64_t seed) {
  Uniform uniform(seed);
  const fgtd::Points<d> corner = (1 - side) * random_points<d>(clusters, seed + 1);
  fgtd::Points<d> points(d, static_cast<Index>(count));
  for (Index j = 0; j < points.cols(); ++j)
    for (int l = 0; l < d; ++l) points(l, j) = corner(l, j % static_cast<Index>(clusters)) + side * uniform();
  return points;
}

template <int d>
fgtd::Points<d> grid_points(std::size_t per_axis, double spacing) {
  std::size_t count = 1;
  for (int l = 0; l < d; ++l) count *= per_axis;
  fgtd::Points<d> points(d, static_cast<Index>(count));
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t l = 0, rest = j; l < d; ++l, rest /= per_axis)
      points(static_cast<Index>(l), static_cast<Index>(j)) = static_cast<double>(rest % per_axis) * spacing;
  return points;
}

template fgtd::Points<2> halton_points<2>(std::size_t);
template fgtd::Points<3> halton_points<3>(std::size_t);
template fgtd::Points<4> halton_points<4>(std::size_t);
template fgtd::Points<2> random_points<2>(std::size_t, std::uint64_t);
template fgtd::Points<3> random_points<3>(std::size_t, std::uint64_t);
template fgtd::Points<2> clustered_points<2>(std::size_t, std::size_t, double, std::uint64_t);
template fgtd::Points<3> clustered_points<3>(std::size_t, std::size_t, double, std::uint64_t);
template fgtd::Points<2> grid_points<2>(std::size_t, double);
template fgtd::Points<3> grid_points<3>(std::size_t, double);

}  // namespace gaussdrift::reproduce
