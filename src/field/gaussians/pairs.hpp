// Sums of matrix Gaussians pair by pair. The matrices of method.md, section 9 collapse to one exponential a pair. The
// inner loop is compiled once for every instruction set, as those of fgtd, and picked when the program runs.
#pragma once

#include <cstddef>

namespace gaussdrift {

/// What the coefficients Gamma_k at x_k are multiplied with; phi = exp(-sigma r^2), r = y - x_k.
enum class GaussianMatrix {
  field,      // Phi = grad grad^T - Laplacian:
              //   Phi Gamma = phi [(2 sigma (d - 1) - 4 sigma^2 r^2) Gamma + 4 sigma^2 r (r . Gamma)]
  curl,       // grad phi x Gamma = -2 sigma phi r x Gamma; d = 2: Gamma is a number, along z
  vorticity,  // of `curl`: d = 3: Phi; d = 2: -Laplacian phi = (4 sigma - 4 sigma^2 r^2) phi
};

/// Components of Gamma_k.
constexpr int gaussian_columns(GaussianMatrix matrix, int dimension) {
  return dimension == 2 && matrix != GaussianMatrix::field ? 1 : dimension;
}
/// Components of the product.
constexpr int gaussian_rows(GaussianMatrix matrix, int dimension) {
  return dimension == 2 && matrix == GaussianMatrix::vorticity ? 1 : dimension;
}

struct GaussianPairs {
  GaussianMatrix matrix;
  int dimension;  // 2 or 3
  double sigma;
  std::size_t sources;
  const double* position;      // [dimension][sources]
  const double* coefficients;  // [columns][sources]
  std::size_t targets;
  const double* target;       // [dimension][target_stride]
  std::size_t target_stride;  //
  double* values;             // [rows][value_stride], overwritten
  std::size_t value_stride;   //
};

/// values[i][.] = sum_k matrix(y_i - x_k) Gamma_k, on up to `threads` threads (0: all). A target's sum is added in the
/// same order whatever the other targets are; rounding grows with N/256 + 256. A target that is NaN gives NaN.
void sum_gaussian_pairs(const GaussianPairs& pairs, int threads);

}  // namespace gaussdrift
