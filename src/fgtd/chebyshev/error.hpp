// Error of a single Gaussian term under `chebyshev`, relative to |lambda| N_alpha. With t = sqrt(sigma) (y - x) an axis
// carries g_a(t) = h~_a(t), a = alpha_l, which is interpolated in x and in y at the P Chebyshev nodes of boxes of the
// scaled side h = side sqrt(sigma):
//   |g^(n)| / sqrt(2^a a!) <= M_{a+n} / sqrt(2^a a!),   M_n = 2^n Gamma((n+1)/2) / sqrt(pi) >= max |d^n/dt^n exp(-t^2)|
//   e_a  = 2 (h/4)^P / P! M_{a+P} / sqrt(2^a a!)            interpolation in one variable
//   E_a  = 2 e_a + (2 (h/4)^P / P!)^2 M_{a+2P} / sqrt(2^a a!)   both: I I' g - g = (I-1) g + (I'-1) g + (I-1)(I'-1) g
//   E    = max_{|alpha| <= K} prod_l (1 + E_{alpha_l}) - 1         all axes, as |g_a| <= 1
// M_n bounds the Fourier integral of the derivative. A pair of boxes that is left out, because on one axis the boxes
// are farther apart than the reach R, costs max_{|t| >= R, a <= K} |g_a(t)| instead.
#pragma once

namespace fgtd::detail {

/// E above.
double interpolation_error(int d, double h, int nodes, int derivative_order);

/// The widest h for which E <= tolerance and, beyond |t|^2 = L = 2 ln(1/tolerance) + 40, a pair of boxes within reach
/// on every axis is right to within tolerance exp(L - |t|^2):
///   with rho = R + 2h no |t_l| is larger, so ((S + E_1 exp(rho^2))^d - S^d) <= exp(40) / tolerance suffices if
///   d rho^2 > L;   E_1 = max E_a,  S = max_{a <= K, |t| <= rho} |g_a(t)| exp(t^2).
/// 0 if there is none.
double widest_side(int d, int nodes, double reach, double tolerance, int derivative_order);

}  // namespace fgtd::detail
