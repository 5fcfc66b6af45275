// The kernels of `spread`: particles to a lattice and back; see core/simd/pack.hpp for what may stand here.
#include "core/simd/pack.hpp"
#include "fgtd/kernels/dimensions.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

/// Places a point on the lattice: the first of its w nodes along each axis, found as an offset, and phi at
/// all of them.
template <int d, int packs>
struct Placement {
  Pack inner[packs] = {};    // phi along axis 0
  double outer[d][16] = {};  // phi along the others

  /// theta is taken from x - k h, exact up to the rounding of its result: h in two parts, the first of few digits.
  CORE_INLINE std::size_t find(const SpreadJob& job, std::size_t j) {
    constexpr double shift = 0x1.8p52;  // adding it rounds to an integer
    std::size_t offset = 0;
    double zeta[d];
    Pack value[d][packs];
    for (int l = 0; l < d; ++l) {
      const double x = job.position[j * d + static_cast<std::size_t>(l)];
      const double k = (x * job.inverse_spacing + (0.5 - 0.5 * job.width) + shift) - shift;
      const double theta = ((k * job.spacing_high - x) + k * job.spacing_low) * job.inverse_spacing + 0.5 * job.width;
      zeta[l] = 2 * theta - 1;
      offset += static_cast<std::size_t>(static_cast<long long>(k) - job.first[l]) * job.stride[l];
    }
    const double* row = job.window + static_cast<std::size_t>(job.degree) * 16;
    for (int l = 0; l < d; ++l)
      for (int v = 0; v < packs; ++v) value[l][v] = load(row + static_cast<std::size_t>(v) * lanes);
    for (int i = job.degree; i-- > 0;) {
      row -= 16;
      for (int v = 0; v < packs; ++v) {
        const Pack coefficient = load(row + static_cast<std::size_t>(v) * lanes);
        for (int l = 0; l < d; ++l) value[l][v] = value[l][v] * zeta[l] + coefficient;
      }
    }
    for (int v = 0; v < packs; ++v) {
      inner[v] = value[0][v];
      for (int l = 1; l < d; ++l) store(outer[l] + static_cast<std::size_t>(v) * lanes, value[l][v]);
    }
    return offset;
  }
};

/// row[k] += factor phi_k along axis 0, for all w nodes of the axes above.
template <int axis, int packs, class Placed>
CORE_INLINE void spread_rows(const SpreadJob& job, const Placed& placed, double factor, double* row) {
  if constexpr (axis == 0) {
    for (int v = 0; v < packs; ++v) {
      double* at = row + static_cast<std::size_t>(v) * lanes;
      store(at, load(at) + placed.inner[v] * factor);
    }
  } else {
    for (int i = 0; i < job.width; ++i, row += job.stride[axis])
      spread_rows<axis - 1, packs>(job, placed, factor * placed.outer[axis][i], row);
  }
}

template <int d, int packs>
void spread_points(const SpreadJob& job) {
  Placement<d, packs> placed;
  for (std::size_t j = job.begin; j < job.end; ++j) {
    const std::size_t offset = placed.find(job, j);
    for (std::size_t k = 0; k < job.columns; ++k)
      spread_rows<d - 1, packs>(job, placed, job.weights[k * job.weights_stride + j],
                                job.lattice + k * job.lattice_stride + offset);
  }
}

template <int axis, int packs, class Placed>
CORE_INLINE void gather_rows(const SpreadJob& job, const Placed& placed, const double* row, Pack factor,
                             Pack (&sum)[packs]) {
  if constexpr (axis == 0) {
    for (int v = 0; v < packs; ++v) sum[v] += load(row + static_cast<std::size_t>(v) * lanes) * factor;
  } else {
    for (int i = 0; i < job.width; ++i, row += job.stride[axis])
      gather_rows<axis - 1, packs>(job, placed, row, factor * placed.outer[axis][i], sum);
  }
}

template <int d, int packs>
void gather_points(const SpreadJob& job) {
  Placement<d, packs> placed;
  for (std::size_t j = job.begin; j < job.end; ++j) {
    const std::size_t offset = placed.find(job, j);
    for (std::size_t k = 0; k < job.columns; ++k) {
      Pack sum[packs] = {};
      gather_rows<d - 1, packs>(job, placed, job.lattice + k * job.lattice_stride + offset, broadcast(1.0), sum);
      Pack all = sum[0] * placed.inner[0];
      for (int v = 1; v < packs; ++v) all += sum[v] * placed.inner[v];
      double value = 0;
      for (std::size_t i = 0; i < lanes; ++i) value += all[i];
      job.out[k * job.out_stride + (j - job.begin)] = value;
    }
  }
}

template <int d, int packs>
void spread_packs(const SpreadJob& job) {
  if constexpr (static_cast<std::size_t>(packs) * lanes <= 16) {
    if (static_cast<std::size_t>(job.width) > static_cast<std::size_t>(packs) * lanes) {
      spread_packs<d, packs + 1>(job);
    } else if (job.out != nullptr) {
      gather_points<d, packs>(job);
    } else {
      spread_points<d, packs>(job);
    }
  }
}

}  // namespace

void spread(const SpreadJob& job) {
  in_dimension(job.dimension, [&](auto dimension) { spread_packs<dimension.d, 1>(job); });
}

}  // namespace fgtd::detail::CORE_ISA
