// How ranks share a case: whether they can, and how much work a tile is.
#pragma once

#include <functional>
#include <string>

#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"
#include "particle/tiles.hpp"

namespace gaussdrift {

/// What keeps ranks from sharing a case, for the user; empty: nothing.
std::string why_not_shared(const VelocityField& velocity);

/// Seconds that a tile takes from the landing at `from` to the next one, and for the density at `from`. Roughly, but
/// tools/bench/bench_tiles shows how evenly ranks are loaded by it.
std::function<double(const Tile& tile)> work_of_tiles(const Case& spec, const VelocityField& velocity, double from);

}  // namespace gaussdrift
