// Harmonic polynomials of a cluster, the functions that its charges and potentials are expanded in: in coordinates t in
// which the cluster is the cube [-stretch/2, stretch/2]^d,
//   2D: 1, Re z^k, Im z^k,  z = t_1 + i t_2;                         2 n + 1 functions up to degree n
//   3D: l! r^l P_l^m(cos theta) {cos, sin}(m phi) / (l + m)!;        (n + 1)^2 functions
// ordered by degree. Each is even or odd under the reflection of every axis.
#pragma once

#include <cstddef>
#include <vector>

namespace farfield::detail {

/// Keeps values of high degree from becoming very large or very small.
constexpr double stretch = 1.5;

constexpr int max_degree = 40;

template <int d>
constexpr std::size_t functions(int degree) {
  const std::size_t n = static_cast<std::size_t>(degree);
  return d == 2 ? 2 * n + 1 : (n + 1) * (n + 1);
}

/// 3D: place of degree l and order m = -l .. l; negative orders are the sines.
constexpr std::size_t place(int l, int m) { return static_cast<std::size_t>(l * l + l + m); }

/// Values of all functions up to `degree` at one point.
template <int d>
void evaluate_harmonics(int degree, const double* t, double* values);

/// Bit l is set if function k changes its sign with t_l.
template <int d>
unsigned parity(std::size_t k);

template <int d>
int degree_of(std::size_t k);

/// Coefficients of the derivatives by t_1, ..., t_d of sum_k coefficient[k] h_k: derivative[l][functions], overwritten.
template <int d>
void differentiate(int degree, const double* coefficient, double* const* derivative);

}  // namespace farfield::detail
