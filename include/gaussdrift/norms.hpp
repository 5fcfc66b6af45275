/// @file
/// How far a density is from the exact one, and how far the exact one is known. docs/method.md, section 7.
#pragma once

#include <cstddef>
#include <string>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// Norms of rho_eps^h - rho on the grid, each divided by that of the exact rho at the same time; NaN where that is 0.
struct ErrorNorms {
  double l1 = 0;    ///< integral of the absolute value
  double l2 = 0;    ///< root of the integral of the square
  double linf = 0;  ///< largest absolute value
};

/// Where the exact density is not known, and what was done to know it.
struct ReferenceReport {
  std::size_t untraced = 0;   ///< points whose value is not known: NaN in the result
  Vector first_untraced{};    ///< one of them
  std::string trouble;        ///< and why
  std::size_t rates = 0;      ///< evaluations of the velocity for one point, summed over all
  std::size_t exhausted = 0;  ///< points, among the untraced, that would take more steps than are allowed
};

}  // namespace gaussdrift
