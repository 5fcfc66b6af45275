// What the kernels of single pairs get and return. Nothing of the standard library: kernels are compiled once for every
// instruction set.
#pragma once

#include <cstddef>

#include "rbf/kernel.hpp"

namespace rbf::detail {

constexpr std::size_t group_size = 32;  // targets of one call

/// The value and all derivatives up to an order, as a list: value, d of first order, those of second order in the order
/// 11, 12, 22 / 11, 12, 13, 22, 23, 33.
constexpr std::size_t most_derivatives = 10;

constexpr std::size_t derivatives_up_to(int dimension, int order) {
  const std::size_t d = static_cast<std::size_t>(dimension);
  return order == 0 ? 1 : order == 1 ? 1 + d : 1 + d + d * (d + 1) / 2;
}

/// Sums over all sources at group_size targets. Distances are between differences of coordinates.
struct PairsJob {
  int dimension;
  Kernel kernel;
  double shape;  // c
  int order;     // of the derivatives wanted: 0, 1, 2
  std::size_t sources;
  const double* position;  // [dimension][sources]
  const double* weights;   // [sources]
  const double* target;    // [dimension][group_size]
  double* out;             // [derivatives_up_to(dimension, order)][group_size], overwritten
};

/// Polynomials in x = 2 s / radius^2 - 1, -1 <= x <= 1, coefficients from the constant on, an even number
/// of them.
struct PolynomialView {
  const double* coefficient;
  std::size_t count;
};

struct Run {
  std::size_t begin, end;
};

constexpr std::size_t near_padding = 8;  // numbers that are readable past the last source

/// Adds kernel minus polynomial over the sources of some runs that are closer to one target than `radius`, for one
/// column of weights.
struct NearJob {
  int dimension;
  Kernel kernel;
  double shape;  // c
  int order;     // of the derivatives wanted: 0, 1, 2
  double radius;
  PolynomialView smooth[3];  // in place of f, f', f''
  std::size_t stride;        // of position
  const double* position;    // [dimension][stride]
  const double* weights;     // [stride]
  const Run* runs;
  std::size_t run_count;
  const double* target;  // [dimension]
  double* out;           // [derivatives_up_to(dimension, order)], overwritten
};

struct Kernels {
  const char* name;
  std::size_t lanes;  // doubles in a vector
  void (*pairs)(const PairsJob&);
  void (*near)(const NearJob&);
};

/// Those of the fastest instruction set that this processor runs.
const Kernels& fastest_kernels();

}  // namespace rbf::detail
