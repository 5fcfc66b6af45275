// Interpolation of Franke's function at random points by the library rbf: the error against the number of points, beside the
// rate that theory states; the error that left-out values tell, beside the true one; the iteration beside the dense solve;
// and the integral of the interpolant.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {

struct InterpolationOptions {
  int fewest_points = 250;  // of the smallest fit; the next ones have 4 times as many
  int most_points = 16000;
  int targets = 10000;  // other points, at which errors are measured
  int threads = 1;
};

/// Errors are root mean squares; Franke's function is 0.5 in that norm.
struct InterpolationFit {
  std::string kernel;
  double shape = 0;  // 0: takes none
  bool shape_was_chosen = false;
  int points = 0;
  bool refused = false;  // the matrix is too near to a singular one; what follows is 0
  std::string solver{};
  int iterations = 0;
  double error = 0;           // at other points
  double left_out = 0;        // as the fit tells
  double rate = 0;            // r: error ~ spacing^r since the fit before; 0 for the first
  double integral_error = 0;  // over the unit square, where the integral is 0.4
  double seconds = 0;         // of the fit
};

/// From the first fit of a kernel to its last that is not refused.
struct InterpolationRate {
  std::string kernel;
  double measured = 0;
  double stated = 0;  // at least; 0: none, as the shape is chosen anew for each number of points
  bool holds() const { return measured >= stated; }
};

/// The same fit by a factorisation and by iteration.
struct InterpolationSolvers {
  std::string kernel;
  int points = 0;
  double dense_error = 0, krylov_error = 0;
  double apart = 0;  // largest difference of both, relative to the largest value
  double dense_seconds = 0, krylov_seconds = 0;
};

struct InterpolationReproduction {
  InterpolationOptions options;
  std::vector<InterpolationFit> fits{};
  std::vector<InterpolationRate> rates{};
  std::vector<InterpolationSolvers> solvers{};
  double seconds = 0;

  /// Every stated rate is reached, and the iteration errs at most 1.5 times as much as the dense solve.
  bool agrees() const;
};

InterpolationReproduction reproduce_interpolation(const InterpolationOptions& options,
                                                  const std::function<void(const std::string&)>& progress = {});

std::string to_text(const InterpolationReproduction& result);
std::string to_json(const InterpolationReproduction& result);

}  // namespace gaussdrift::reproduce
