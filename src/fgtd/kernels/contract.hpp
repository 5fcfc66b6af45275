// Contracts tensors of coefficients with factors of every axis: the inner loop of `hermite` and `chebyshev` at targets.
// For the sources that may include core/simd/pack.hpp.
#pragma once

#include "core/simd/pack.hpp"

namespace fgtd::detail::CORE_ISA {

using namespace gaussdrift::core::CORE_ISA;

namespace {

/// sums[i] = sum_b moments[i terms + b] g[b] for `rows` rows; g[b] is `packs` packs. Several rows side by side keep
/// the multipliers busy; a single sum would make them wait for its last addition.
template <int rows, int packs>
CORE_INLINE void contract_rows(std::size_t terms, const double* moments, const double* g, Pack (&sums)[rows][packs]) {
  for (int i = 0; i < rows; ++i)
    for (int v = 0; v < packs; ++v) sums[i][v] = Pack{};
  for (std::size_t b = 0; b < terms; ++b) {
    Pack factor[packs];
    for (int v = 0; v < packs; ++v) factor[v] = load(g + (b * packs + static_cast<std::size_t>(v)) * lanes);
    for (int i = 0; i < rows; ++i) {
      const double moment = moments[static_cast<std::size_t>(i) * terms + b];
      for (int v = 0; v < packs; ++v) sums[i][v] += factor[v] * moment;
    }
  }
}

/// Rows b .. b+rows of the second axis, added to `sum`.
template <int rows, int packs>
CORE_INLINE void contract_plane_rows(std::size_t terms, std::size_t b, const double* moments, const double* const* g,
                                     Pack (&sum)[packs]) {
  Pack inner[rows][packs];
  contract_rows<rows, packs>(terms, moments + b * terms, g[0], inner);
  for (int i = 0; i < rows; ++i)
    for (int v = 0; v < packs; ++v)
      sum[v] +=
          inner[i][v] * load(g[1] + ((b + static_cast<std::size_t>(i)) * packs + static_cast<std::size_t>(v)) * lanes);
}

/// sum_beta moments[beta] prod_{l <= axis} g_l[beta_l], first axis fastest; advances `moments` past what was read.
template <int axis, int packs>
CORE_INLINE void contract(std::size_t terms, const double*& moments, const double* const* g, Pack (&sum)[packs]) {
  if constexpr (axis == 0) {
    Pack row[1][packs];
    contract_rows<1, packs>(terms, moments, g[0], row);
    for (int v = 0; v < packs; ++v) sum[v] = row[0][v];
    moments += terms;
  } else if constexpr (axis == 1) {
    for (int v = 0; v < packs; ++v) sum[v] = Pack{};
    std::size_t b = 0;
    for (; b + 4 <= terms; b += 4) contract_plane_rows<4, packs>(terms, b, moments, g, sum);
    if (b + 2 <= terms) {
      contract_plane_rows<2, packs>(terms, b, moments, g, sum);
      b += 2;
    }
    if (b < terms) contract_plane_rows<1, packs>(terms, b, moments, g, sum);
    moments += terms * terms;
  } else {
    for (int v = 0; v < packs; ++v) sum[v] = Pack{};
    for (std::size_t b = 0; b < terms; ++b) {
      Pack inner[packs];
      contract<axis - 1, packs>(terms, moments, g, inner);
      for (int v = 0; v < packs; ++v)
        sum[v] += inner[v] * load(g[axis] + (b * packs + static_cast<std::size_t>(v)) * lanes);
    }
  }
}

}  // namespace
}  // namespace fgtd::detail::CORE_ISA
