// A kernel on [near, R] as a sum of Gaussians to a given accuracy. docs/rbf.md, "The Gaussians".
//
//     phi(r) = p_0 + p_1 r^2 + p_2 r^4 + sum_k w_k exp(-t_k r^2)
//
// The integral over Gaussians of catalogue.hpp is cut where its ends fall below the accuracy, and replaced by a
// trapezoidal rule in ln t. Then least squares choose the weights, which allows fewer terms. The error is measured.
#pragma once

#include <array>
#include <vector>

#include "rbf/catalogue.hpp"

namespace rbf::detail {

struct WeightedGaussian {
  double exponent = 0, weight = 0;
};

/// Coefficients of 1, r^2, r^4.
using Polynomial = std::array<double, 3>;

struct Expansion {
  Polynomial polynomial{};
  std::vector<WeightedGaussian> terms;  // widest first
  Scales scales;                        // what errors are relative to
  double error = 0;                     // measured, relative: the worst of value and derivatives

  /// At s = r^2.
  Profile profile(long double s) const;
};

/// The exponent up to which Gaussians count, for all distances up to `range`. Beyond exp(-gone) they do not.
double finest_exponent(const Function& function, double range, int order, double accuracy);
constexpr double gone = 12;

/// Which exponents are wanted: `fewest` takes longest to find.
enum class Exponents { fewest, even };

/// @param range     R > 0
/// @param near      0 <= near < R: distances below are left out
/// @param order     of the derivatives that have to be accurate too, 0 .. 2
/// @param accuracy  relative error that is allowed of the kernel and of each derivative
/// @throws ToleranceError  there is none
Expansion expand(const Function& function, double range, double near, int order, double accuracy,
                 Exponents exponents = Exponents::fewest);

}  // namespace rbf::detail
