// The sum as the methods see it: points by axis, in units in which they extend over about 1, charges up to 1, and one
// of three interactions. The engine turns the result into that of the kernel asked for.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

#include "core/buffer.hpp"
#include "farfield/farfield.hpp"
#include "farfield/kernels/kernels.hpp"

namespace farfield::detail {

using gaussdrift::core::Buffer;

/// Coordinates by axis, each readable `padding` numbers past its end.
using Coordinates = std::array<Buffer<double>, 3>;

struct Problem {
  Interaction interaction = Interaction::inverse;
  bool potential = true;
  double inverse_squared_core = 0;  // 1/eps^2, of blob
  double log_shift = 0;             // ln of the unit of length
  bool self = true;                 // the sources are the targets
  std::size_t sources = 0, targets = 0;
  Coordinates source, target;  // target is empty if self

  int dimension() const { return interaction == Interaction::inverse ? 3 : 2; }
  const Coordinates& target_points() const { return self ? source : target; }
};

/// Arrays of results, by target, zero at first, padded like coordinates.
struct Sums {
  Buffer<double> potential;
  Coordinates field;
};

/// Seconds since the last lap.
class Laps {
 public:
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - last_;
    last_ = now;
    return passed.count();
  }

 private:
  std::chrono::steady_clock::time_point last_ = std::chrono::steady_clock::now();
};

/// Sums for charges (padded, by source); what a method has prepared.
class Summation {
 public:
  virtual ~Summation() = default;
  virtual void evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const = 0;
  virtual double evaluation_bytes() const = 0;
};

}  // namespace farfield::detail
