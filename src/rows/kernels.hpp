// The table of row functions of one instruction set; see core/simd/pack.hpp for why it knows no standard library.
#pragma once

#include <cstddef>

namespace gaussdrift::rows {

/// a[i] = f(a[i]) for i < count.
using Unary = void (*)(double* a, std::size_t count);
/// a[i] = f(a[i], b[i]); b_same: b has one number, which stands for all.
using Binary = void (*)(double* a, const double* b, bool b_same, std::size_t count);

/// out[i] = ((base[i] + factors[0] terms[0][i]) + factors[1] terms[1][i]) + ...; out may be base.
using Combine = void (*)(double* out, const double* base, const double* const* terms, const double* factors,
                         std::size_t term_count, std::size_t count);

struct Kernels {
  Unary negate, square, cube, fourth, abs, sqrt;
  Unary sin, cos, tan, asin, acos, atan, tanh, atanh, exp, log, log2, log10, cbrt, erf;
  Binary add, subtract, multiply, divide, pow, atan2, hypot;
  Binary less, greater, less_equal, greater_equal, equal, not_equal, both, either;  // 1 or 0
  Combine combine;
};

}  // namespace gaussdrift::rows
