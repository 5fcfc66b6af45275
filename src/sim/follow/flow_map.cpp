#include "sim/follow/flow_map.hpp"

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>

#include "base/nan.hpp"
#include "base/parallel.hpp"

namespace gaussdrift {

namespace {

using base::nan;
constexpr std::size_t block = 1024;
constexpr double seconds_of_a_particle = 2e-7;

template <class Work>
void for_blocks(std::size_t count, int threads, const Work& work) {
  base::parallel_for({(count + block - 1) / block, static_cast<double>(count) * seconds_of_a_particle}, threads,
                     [&](std::size_t b) {
                       for (std::size_t j = b * block, end = std::min(count, j + block); j < end; ++j) work(j);
                     });
}

/// Finds particles by their points of the lattice.
class Neighbours {
 public:
  Neighbours(const Particles& particles, const Lattice& lattice, const Folding& folding)
      : id_(particles.id), lattice_(lattice), folding_(folding) {}

  /// The particle that began `step` points further along the axis, over a periodic end as well.
  std::optional<std::size_t> along(std::int64_t id, int axis, int step) const {
    std::int64_t stride = 1;
    for (int k = 0; k < axis; ++k) stride *= points(k);
    const std::int64_t here = id / stride % points(axis);
    std::int64_t there = here + step;
    if (folding_.axis(axis).periodic) there = (there + points(axis)) % points(axis);
    if (there < 0 || there >= points(axis) || there == here) return std::nullopt;
    const std::int64_t wanted = id + (there - here) * stride;
    const auto found = std::lower_bound(id_.begin(), id_.end(), wanted);
    if (found == id_.end() || *found != wanted) return std::nullopt;
    return static_cast<std::size_t>(found - id_.begin());
  }

 private:
  std::int64_t points(int axis) const {
    return static_cast<std::int64_t>(lattice_.points[static_cast<std::size_t>(axis)]);
  }

  const std::vector<std::int64_t>& id_;
  const Lattice& lattice_;
  const Folding& folding_;
};

template <int d>
double largest_singular_value(const double* gradient) {
  using Matrix = Eigen::Matrix<double, d, d, Eigen::RowMajor>;
  const Eigen::Map<const Matrix> matrix(gradient);
  if (!matrix.allFinite()) return nan;  // a solver does not end on what is no number
  if constexpr (d == 2) {
    const double a = matrix(0, 0), b = matrix(0, 1), c = matrix(1, 0), e = matrix(1, 1);
    return (std::hypot(a + e, b - c) + std::hypot(a - e, b + c)) / 2;
  } else {
    const Eigen::Matrix3d copy = matrix;
    return Eigen::JacobiSVD<Eigen::Matrix3d>(copy).singularValues()(0);
  }
}

}  // namespace

std::vector<double> flow_map_gradients(const Particles& particles, const Lattice& lattice, const Folding& folding,
                                       int threads) {
  const auto d = static_cast<std::size_t>(particles.dimension);
  std::vector<double> gradients(particles.size() * d * d, nan);
  const Neighbours neighbours(particles, lattice, folding);
  const auto on_lattice = static_cast<std::int64_t>(lattice.size());
  for_blocks(particles.size(), threads, [&](std::size_t j) {
    const std::int64_t id = particles.id[j];
    if (id >= on_lattice) return;
    for (std::size_t k = 0; k < d; ++k) {
      const auto after = neighbours.along(id, static_cast<int>(k), 1),
                 before = neighbours.along(id, static_cast<int>(k), -1);
      if (!after && !before) continue;
      const double apart = (after && before ? 2 : 1) * lattice.spacing;
      for (std::size_t i = 0; i < d; ++i) {
        const std::vector<double>& x = particles.position[i];
        double way = x[after.value_or(j)] - x[before.value_or(j)];
        if (const FoldedAxis& axis = folding.axis(static_cast<int>(i)); axis.periodic)
          way = std::remainder(way, axis.high - axis.low);
        gradients[(j * d + i) * d + k] = way / apart;
      }
    }
  });
  return gradients;
}

std::vector<double> lyapunov_exponents(const std::vector<double>& gradients, int dimension, double t, int threads) {
  const std::size_t numbers = static_cast<std::size_t>(dimension) * static_cast<std::size_t>(dimension);
  std::vector<double> exponents(gradients.size() / numbers, nan);
  if (t == 0) return exponents;
  for_blocks(exponents.size(), threads, [&](std::size_t j) {
    const double* const gradient = gradients.data() + j * numbers;
    const double stretched = dimension == 2 ? largest_singular_value<2>(gradient) : largest_singular_value<3>(gradient);
    exponents[j] = std::log(stretched) / std::abs(t);
  });
  return exponents;
}

}  // namespace gaussdrift
