#include "sim/particle_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "particle/pieces_by_id.hpp"
#include "particle/placing.hpp"
#include "particle/subset.hpp"

namespace gaussdrift {

namespace {

// Velocities travel as integrals.
base::Bytes with_velocity(const Particles& particles, const std::vector<double>& velocity,
                          std::vector<std::size_t> chosen) {
  Particles some = subset(particles, chosen);
  const auto dimension = static_cast<std::size_t>(some.dimension);
  some.path.assign(dimension, std::vector<double>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i)
    for (std::size_t k = 0; k < dimension; ++k) some.path[k][i] = velocity[chosen[i] * dimension + k];
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  return pack(some, chosen);
}

std::vector<double> velocity_of(Particles& particles) {
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  std::vector<double> velocity(particles.size() * dimension);
  for (std::size_t k = 0; k < dimension; ++k)
    for (std::size_t i = 0; i < particles.size(); ++i) velocity[i * dimension + k] = particles.path[k][i];
  particles.path.clear();
  return velocity;
}

}  // namespace

std::size_t pieces_of_particles(std::size_t count, double most) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(static_cast<double>(count) / most)));
}

void hand_out_particles(const Particles& particles, const std::vector<double>& velocity, std::size_t pieces,
                        base::Communicator& ranks, const std::function<void(const ParticlePiece&)>& receive) {
  Particles none;
  none.dimension = particles.dimension;
  none.path.resize(static_cast<std::size_t>(none.dimension));
  hand_out_by_id(
      particles, equal_pieces(particles_of_all(particles, ranks), pieces), ranks, none,
      [&](const std::vector<std::size_t>& chosen) { return with_velocity(particles, velocity, chosen); },
      [&](std::size_t piece, Particles& own) {
        const std::vector<double> of_own = velocity_of(own);
        receive({piece, &own, &of_own});
      });
}

}  // namespace gaussdrift
