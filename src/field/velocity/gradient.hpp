// How fast neighbouring particles move apart: the gradient of a velocity field, by sampling.
#pragma once

#include "base/points.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

struct GradientSample {
  double largest = 0;  // max over the sample of the Frobenius norm |grad u|, in 1 / time; at least the spectral norm
  Vector place{};      // where it was met
  double time = 0;     // and when
  double speed = 0;    // max |u| over the sample
  bool finite = true;  // false: u was not finite somewhere; such places are left out
};

/// Samples u at points of a Halton sequence in the box, at evenly spaced times from `begin` to `end` (at one time for a
/// steady field). Central differences over a millionth of the box are right to about 1e-9 of the largest gradient. It
/// is a lower bound of the true maximum, because places in between are not seen.
GradientSample sample_gradient(const VelocityField& field, int dimension, const Vector& min, const Vector& max,
                               double begin, double end, std::size_t points = 4096, int times = 9);

}  // namespace gaussdrift
