// Errors of a single Gaussian term under `hermite`, relative to |lambda| N_alpha, worst over all |alpha| <=
// K. Parameters are chosen by these bounds, which sharpen those of the thesis: the series in the proof of
// Satz 3.7.2 are summed, not estimated by geometric series, and the kept part is compared with the exact
// factor.
//   e_k = sum_{m >= p} r^m sqrt(binomial(m+k, k) / m!)          tail of one axis, relative to sqrt(2^k k!)
//   E   = max_alpha prod_l (1 + e_{alpha_l}) - 1                a box that is summed (docs/fgtd.md)
// and a box that is left out costs max_alpha |h_alpha| / N_alpha beyond the reach. A term suffers one or the other.
#pragma once

#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

/// E above.
double kept_error(int d, double r, int p, int derivative_order);

/// ln of max_alpha (prod S_{alpha_l} - prod (S - e)_{alpha_l}), S_k = e_k with p = 0: the error of a box that is summed
/// is also below exp(this - |t|^2 / 2), t = sqrt(sigma) (y - c).
double log_far_error(int d, double r, int p, int derivative_order);

/// Upper bound of |h_alpha(t)| / sqrt(2^|alpha| alpha!) for every |t| >= rho and |alpha| <= derivative_order, by
/// exp(-rho^2/2) [Sch06, Lemma 3.7.3 with K = 1] or, for rho^2 >= derivative_order / 2, exp(-rho^2) times the
/// polynomials with all coefficients made positive.
double dropped_error(int d, double rho, int derivative_order);

/// The smallest rho with dropped_error(rho) <= tolerance.
double find_reach(int d, double tolerance, int derivative_order);

/// Bound (3.5) divided by sqrt(2^|alpha| alpha!), worst over |alpha| <= derivative_order; none if it holds for not all.
template <int d>
std::optional<double> thesis_bound(double r, int p, int n, int derivative_order);

}  // namespace fgtd::detail
