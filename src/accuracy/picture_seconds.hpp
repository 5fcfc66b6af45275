// What pictures take, predicted: processor seconds by style and size, measured once and scaled to the machine at hand.
#pragma once

#include <cstddef>

#include "gaussdrift/case.hpp"

namespace gaussdrift::accuracy {

/// Pictures that are drawn again at the end with a wider range of colours.
struct Redrawn {
  bool density = false, error = false;
};

/// All pictures of a run, with the start of the drawing library. `points`: of the grid.
double seconds_of_pictures(const Case& spec, std::size_t points, Redrawn again);

/// How many times as long as on the machine of the constants a small drawing takes here.
double slowness_of_this_machine();

}  // namespace gaussdrift::accuracy
