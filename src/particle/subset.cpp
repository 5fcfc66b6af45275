#include "particle/subset.hpp"

namespace gaussdrift {

Particles subset(const Particles& all, const std::vector<std::size_t>& chosen) {
  Particles some;
  some.dimension = all.dimension;
  for (const std::size_t j : chosen) {
    for (int k = 0; k < all.dimension; ++k) some.position[k].push_back(all.position[k][j]);
    some.alpha.push_back(all.alpha[j]);
    some.id.push_back(all.id[j]);
  }
  return some;
}

}  // namespace gaussdrift
