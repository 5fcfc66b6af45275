#include "sim/particle_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "particle/pieces_by_id.hpp"
#include "particle/placing.hpp"
#include "particle/subset.hpp"

namespace gaussdrift {

namespace {

// Velocities travel as integrals, and after them the components of fields.
base::Bytes with_velocity(const Particles& particles, const std::vector<double>& velocity,
                          const std::vector<FieldOnGrid>& fields, std::vector<std::size_t> chosen) {
  Particles some = subset(particles, chosen);
  const auto add = [&](const std::vector<double>& values, std::size_t components) {
    for (std::size_t k = 0; k < components; ++k) {
      std::vector<double>& column = some.path.emplace_back(chosen.size());
      for (std::size_t i = 0; i < chosen.size(); ++i) column[i] = values[chosen[i] * components + k];
    }
  };
  add(velocity, static_cast<std::size_t>(some.dimension));
  for (const FieldOnGrid& field : fields) add(field.values, static_cast<std::size_t>(field.components));
  std::iota(chosen.begin(), chosen.end(), std::size_t{0});
  return pack(some, chosen);
}

// Takes some of them, from `first` on.
std::vector<double> components_of(const Particles& particles, std::size_t first, std::size_t components) {
  std::vector<double> values(particles.size() * components);
  for (std::size_t k = 0; k < components; ++k)
    for (std::size_t i = 0; i < particles.size(); ++i) values[i * components + k] = particles.path[first + k][i];
  return values;
}

}  // namespace

std::size_t pieces_of_particles(std::size_t count, double most) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(static_cast<double>(count) / most)));
}

void hand_out_particles(const Particles& particles, const std::vector<double>& velocity,
                        const std::vector<FieldOnGrid>& fields, std::size_t pieces, base::Communicator& ranks,
                        const std::function<void(const ParticlePiece&)>& receive) {
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  std::size_t columns = dimension;
  for (const FieldOnGrid& field : fields) columns += static_cast<std::size_t>(field.components);
  Particles none;
  none.dimension = particles.dimension;
  none.path.resize(columns);
  hand_out_by_id(
      particles, equal_pieces(particles_of_all(particles, ranks), pieces), ranks, none,
      [&](const std::vector<std::size_t>& chosen) { return with_velocity(particles, velocity, fields, chosen); },
      [&](std::size_t piece, Particles& own) {
        const std::vector<double> of_own = components_of(own, 0, dimension);
        std::vector<FieldOnGrid> fields_of_own;
        std::size_t first = dimension;
        for (const FieldOnGrid& field : fields) {
          const auto components = static_cast<std::size_t>(field.components);
          fields_of_own.push_back({field.name, field.components, components_of(own, first, components)});
          first += components;
        }
        own.path.clear();
        receive({piece, &own, &of_own, fields.empty() ? nullptr : &fields_of_own});
      });
}

}  // namespace gaussdrift
