// Many steps of a Runge-Kutta method for a block of particles in one call: a field whose formula is short keeps positions and
// rates in the registers of the processor.
#pragma once

#include <array>
#include <cstddef>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// An explicit Runge-Kutta method and steps of it, as plain numbers for kernels.
struct BlockSteps {
  int stages = 0;
  const double* stage_weights = nullptr;  // a_il, the strictly lower triangle row by row
  const double* weights = nullptr;        // b_i
  std::size_t steps = 0;
  const double* lengths = nullptr;  // of the steps
  const double* of_time = nullptr;  // for each stage of each step the numbers of at_time(), one stage after the other
};

class BlockCarrier {
 public:
  virtual ~BlockCarrier() = default;
  /// How many numbers the formula takes of t.
  virtual std::size_t time_values() const = 0;
  /// Those numbers.
  virtual void at_time(double t, double* values) const = 0;
  /// Takes the steps with `count` particles; x has an array an axis. The same bits as stages of VelocityField::add that
  /// time::step combines, but for the sign of zeros.
  virtual void carry(const BlockSteps& steps, const std::array<double*, max_dimension>& x, std::size_t count) const = 0;
};

}  // namespace gaussdrift
