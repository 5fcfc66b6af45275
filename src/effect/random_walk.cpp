#include "effect/random_walk.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/parallel.hpp"
#include "base/philox.hpp"
#include "effect/diffusivity.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t block_length = 256;

/// D = root root^T also where an eigenvalue is 0.
Tensor root_of(const Tensor& matrix) {
  Tensor root{};
  for (std::size_t i = 0; i < max_dimension; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = matrix[i][j];
      for (std::size_t k = 0; k < j; ++k) rest -= root[i][k] * root[j][k];
      if (i == j)
        root[i][i] = std::sqrt(std::max(0.0, rest));
      else if (root[j][j] > 0)
        root[i][j] = rest / root[j][j];
    }
  return root;
}

/// Independent normal numbers of a particle, an axis each.
Vector normals_of(std::uint64_t seed, std::int64_t id, std::uint64_t part, int dimension) {
  const auto key = static_cast<std::uint64_t>(id);
  const auto [x, y] = base::two_normals(seed, key, 2 * part);
  return {x, y, dimension == 3 ? base::two_normals(seed, key, 2 * part + 1)[0] : 0};
}

}  // namespace

RandomWalk::RandomWalk(const Options& options) : options_(options), root_(root_of(options.diffusion)) {}

std::string RandomWalk::describe() const {
  const std::string coefficient = options_.field ? options_.field->describe() : words_of_tensor(options_.diffusion);
  return fmt::format("diffusion div(D grad rho) by a random walk, D = {}, seed {}", coefficient, options_.seed);
}

void RandomWalk::add_coefficient(const Particles& particles, std::size_t first, const PointsView& x, double time,
                                 double* values) const {
  std::fill_n(values, x.count, 0.0);
  options_.field->add(time, x, values);
  check_diffusivity(x, values, particles.id.data() + first, time);
}

// With a field every particle looks with the coefficient where it stands, and goes with that of where it has looked, by
// the same random numbers. The mean of the way is then the gradient of D to first order in the length of the step, as
// it has to be for a uniform density to stay uniform, without a derivative of D [HT82, LQF00].
void RandomWalk::scatter(Particles& particles, const Scattering& part) {
  const int dimension = particles.dimension;
  const auto axes = static_cast<std::size_t>(dimension);
  const std::size_t blocks = (particles.size() + block_length - 1) / block_length;
  const double unit = std::sqrt(2 * part.length), middle = part.time + part.length / 2;
  constexpr double seconds = 8e-8;  // of a particle, roughly
  base::parallel_for({blocks, seconds * static_cast<double>(particles.size())}, options_.threads, [&](std::size_t b) {
    const std::size_t first = b * block_length, length = std::min(block_length, particles.size() - first);
    std::array<std::array<double, block_length>, max_dimension> way, looked_at;
    for (std::size_t i = 0; i < length; ++i) {
      const Vector draws = normals_of(options_.seed, particles.id[first + i], part.number, dimension);
      for (std::size_t k = 0; k < axes; ++k) {
        double sum = 0;
        for (std::size_t l = 0; l <= k; ++l) sum += root_[k][l] * draws[l];
        way[k][i] = unit * sum;
      }
    }
    if (options_.field) {
      std::array<double, block_length> coefficient;
      PointsView there{dimension, length, {}};
      for (std::size_t k = 0; k < axes; ++k) there.axis[k] = looked_at[k].data();
      add_coefficient(particles, first, particles.view().block(first, length), middle, coefficient.data());
      for (std::size_t k = 0; k < axes; ++k)
        for (std::size_t i = 0; i < length; ++i)
          looked_at[k][i] = particles.position[k][first + i] + std::sqrt(coefficient[i]) * way[k][i];
      add_coefficient(particles, first, there, middle, coefficient.data());
      for (std::size_t k = 0; k < axes; ++k)
        for (std::size_t i = 0; i < length; ++i) way[k][i] *= std::sqrt(coefficient[i]);
    }
    for (std::size_t k = 0; k < axes; ++k)
      for (std::size_t i = 0; i < length; ++i) particles.position[k][first + i] += way[k][i];
  });
}

std::string RandomWalk::warning() const {
  constexpr double noticed = 0.005;
  const double noise = 1 / std::sqrt(options_.particles_a_blob);
  if (noise < noticed) return "";
  return fmt::format(
      "about {:.3g} particles share a blob, so chance changes the density by some {:.2g} % where it is as large as at "
      "the "
      "start, and by more where it has fallen: with the root of the number. Four times as many particles in a blob, by "
      "particles.per_axis and particles.overlap both doubled, halve that (docs/method.md, section 8.2).",
      options_.particles_a_blob, 100 * noise);
}

Numbers RandomWalk::numbers() const {
  return {{"seed", static_cast<double>(options_.seed)}, {"particles_in_a_blob", options_.particles_a_blob}};
}

}  // namespace gaussdrift
