// What the films of a run cost, predicted.
#pragma once

#include <cstddef>

#include "gaussdrift/case.hpp"

namespace gaussdrift::render {

struct FilmCost {
  double seconds = 0;  // of one core, to draw and write them
  double bytes = 0;    // of the films
  double kept = 0;     // bytes of the frames, until the films are made
};

/// Nothing without an animation. `points`: of the grid of frames.
FilmCost film_cost(const Case& spec, std::size_t points);

}  // namespace gaussdrift::render
