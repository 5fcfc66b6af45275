// The arrays of particles, one after the other.
#pragma once

#include <cstddef>
#include <string_view>

#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// Calls visit(name, number, array) for every array that the particles have, in an order that never changes; the number
/// tells arrays of one name apart. Each has numbers of eight bytes. Works on const and on other particles.
template <class SomeParticles, class Visit>
void for_each_column(SomeParticles& particles, const Visit& visit) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(particles.dimension); ++k)
    visit(std::string_view("position"), k, particles.position[k]);
  visit(std::string_view("alpha"), std::size_t{0}, particles.alpha);
  visit(std::string_view("id"), std::size_t{0}, particles.id);
  for (std::size_t q = 0; q < particles.path.size(); ++q) visit(std::string_view("path"), q, particles.path[q]);
  for (std::size_t q = 0; q < particles.tracers.size(); ++q) visit(std::string_view("tracer"), q, particles.tracers[q]);
  for (std::size_t q = 0; q < particles.kept.size(); ++q) visit(std::string_view("kept"), q, particles.kept[q]);
  if (!particles.volume.empty()) visit(std::string_view("volume"), std::size_t{0}, particles.volume);
}

}  // namespace gaussdrift
