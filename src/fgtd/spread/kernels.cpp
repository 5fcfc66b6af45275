// The kernels of `spread`: particles to a lattice and back; see core/simd/vector.hpp for what may stand here.
#include "core/simd/vector.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

/// Places a point on the lattice: the first of its w nodes along each axis, found as an offset, and phi at
/// all of them.
template <int d, int vectors>
struct Placement {
  Vector inner[vectors] = {};  // phi along axis 0
  double outer[d][16] = {};    // phi along the others

  /// theta is taken from x - k h, exact up to the rounding of its result: h in two parts, the first of few digits.
  CORE_INLINE std::size_t find(const SpreadJob& job, std::size_t j) {
    constexpr double shift = 0x1.8p52;  // adding it rounds to an integer
    std::size_t offset = 0;
    double zeta[d];
    Vector value[d][vectors];
    for (int l = 0; l < d; ++l) {
      const double x = job.position[j * d + static_cast<std::size_t>(l)];
      const double k = (x * job.inverse_spacing + (0.5 - 0.5 * job.width) + shift) - shift;
      const double theta = ((k * job.spacing_high - x) + k * job.spacing_low) * job.inverse_spacing + 0.5 * job.width;
      zeta[l] = 2 * theta - 1;
      offset += static_cast<std::size_t>(static_cast<long long>(k) - job.first[l]) * job.stride[l];
    }
    const double* row = job.window + static_cast<std::size_t>(job.degree) * 16;
    for (int l = 0; l < d; ++l)
      for (int v = 0; v < vectors; ++v) value[l][v] = load(row + static_cast<std::size_t>(v) * lanes);
    for (int i = job.degree; i-- > 0;) {
      row -= 16;
      for (int v = 0; v < vectors; ++v) {
        const Vector coefficient = load(row + static_cast<std::size_t>(v) * lanes);
        for (int l = 0; l < d; ++l) value[l][v] = value[l][v] * zeta[l] + coefficient;
      }
    }
    for (int v = 0; v < vectors; ++v) {
      inner[v] = value[0][v];
      for (int l = 1; l < d; ++l) store(outer[l] + static_cast<std::size_t>(v) * lanes, value[l][v]);
    }
    return offset;
  }
};

/// row[k] += factor phi_k along axis 0, for all w nodes of the axes above.
template <int axis, int vectors, class Placed>
CORE_INLINE void spread_rows(const SpreadJob& job, const Placed& placed, double factor, double* row) {
  if constexpr (axis == 0) {
    for (int v = 0; v < vectors; ++v) {
      double* at = row + static_cast<std::size_t>(v) * lanes;
      store(at, load(at) + placed.inner[v] * factor);
    }
  } else {
    for (int i = 0; i < job.width; ++i, row += job.stride[axis])
      spread_rows<axis - 1, vectors>(job, placed, factor * placed.outer[axis][i], row);
  }
}

template <int d, int vectors>
void spread_points(const SpreadJob& job) {
  Placement<d, vectors> placed;
  for (std::size_t j = job.begin; j < job.end; ++j) {
    const std::size_t offset = placed.find(job, j);
    for (std::size_t k = 0; k < job.columns; ++k)
      spread_rows<d - 1, vectors>(job, placed, job.weights[k * job.weights_stride + j],
                                  job.lattice + k * job.lattice_stride + offset);
  }
}

template <int axis, int vectors, class Placed>
CORE_INLINE void gather_rows(const SpreadJob& job, const Placed& placed, const double* row, Vector factor,
                             Vector (&sum)[vectors]) {
  if constexpr (axis == 0) {
    for (int v = 0; v < vectors; ++v) sum[v] += load(row + static_cast<std::size_t>(v) * lanes) * factor;
  } else {
    for (int i = 0; i < job.width; ++i, row += job.stride[axis])
      gather_rows<axis - 1, vectors>(job, placed, row, factor * placed.outer[axis][i], sum);
  }
}

template <int d, int vectors>
void gather_points(const SpreadJob& job) {
  Placement<d, vectors> placed;
  for (std::size_t j = job.begin; j < job.end; ++j) {
    const std::size_t offset = placed.find(job, j);
    for (std::size_t k = 0; k < job.columns; ++k) {
      Vector sum[vectors] = {};
      gather_rows<d - 1, vectors>(job, placed, job.lattice + k * job.lattice_stride + offset, broadcast(1.0), sum);
      Vector all = sum[0] * placed.inner[0];
      for (int v = 1; v < vectors; ++v) all += sum[v] * placed.inner[v];
      double value = 0;
      for (std::size_t i = 0; i < lanes; ++i) value += all[i];
      job.out[k * job.out_stride + (j - job.begin)] = value;
    }
  }
}

template <int d, int vectors>
void spread_vectors(const SpreadJob& job) {
  if constexpr (static_cast<std::size_t>(vectors) * lanes <= 16) {
    if (static_cast<std::size_t>(job.width) > static_cast<std::size_t>(vectors) * lanes) {
      spread_vectors<d, vectors + 1>(job);
    } else if (job.out != nullptr) {
      gather_points<d, vectors>(job);
    } else {
      spread_points<d, vectors>(job);
    }
  }
}

}  // namespace

void spread(const SpreadJob& job) {
  switch (job.dimension) {
    case 1:
      return spread_vectors<1, 1>(job);
    case 2:
      return spread_vectors<2, 1>(job);
    case 3:
      return spread_vectors<3, 1>(job);
    default:
      return spread_vectors<4, 1>(job);
  }
}

}  // namespace fgtd::detail::CORE_ISA
