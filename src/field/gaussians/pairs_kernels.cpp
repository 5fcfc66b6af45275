// The kernels of sum_gaussian_pairs(); see core/simd/pack.hpp for what may stand here.
#include "core/simd/functions.hpp"
#include "field/gaussians/pairs_job.hpp"

namespace gaussdrift::detail::CORE_ISA {

using namespace core::CORE_ISA;

namespace {

constexpr std::size_t pairs_chunk = 256;  // partial sums of so many terms, then added: rounding grows with N/256 + 256

enum { field_matrix, curl_matrix, vorticity_matrix };  // GaussianMatrix

/// The matrix at r times gamma, without a constant factor, added to `sum`; e = -sigma r^2, phi = exp(e).
template <int matrix, int d, int columns, int rows>
CORE_INLINE void add_pair(const Pack (&r)[d], Pack e, double sigma, const double (&gamma)[columns], Pack (&sum)[rows]) {
  const Pack phi = exp_interpolated(e);
  if constexpr (matrix == curl_matrix) {
    if constexpr (d == 2) {  // grad phi x gamma e_z
      const Pack weight = phi * gamma[0];
      sum[0] += weight * r[1];
      sum[1] -= weight * r[0];
    } else {
      for (int i = 0; i < 3; ++i)
        sum[i] += phi * (r[(i + 1) % 3] * gamma[(i + 2) % 3] - r[(i + 2) % 3] * gamma[(i + 1) % 3]);
    }
  } else if constexpr (columns == 1) {
    sum[0] += phi * (e + 1.0) * gamma[0];
  } else {
    Pack along = r[0] * gamma[0];
    for (int l = 1; l < d; ++l) along += r[l] * gamma[l];
    along *= phi * sigma;
    const Pack isotropic = phi * (e + (d - 1) * 0.5);
    for (int l = 0; l < d; ++l) {
      sum[l] += isotropic * gamma[l];
      sum[l] += along * r[l];
    }
  }
}

template <int matrix, int d, int columns, int rows>
void sum_pairs(const PairsJob& job) {
  const double factor = (matrix == curl_matrix ? -2 : 4) * job.sigma;
  for (std::size_t first = 0; first < target_group; first += lanes) {
    Pack y[d];
    for (int l = 0; l < d; ++l) y[l] = load(job.target + static_cast<std::size_t>(l) * target_group + first);
    Pack total[rows] = {};
    for (std::size_t begin = 0; begin < job.sources; begin += pairs_chunk) {
      const std::size_t end = begin + pairs_chunk < job.sources ? begin + pairs_chunk : job.sources;
      Pack partial[rows] = {};
      for (std::size_t j = begin; j < end; ++j) {
        double gamma[columns];
        for (int k = 0; k < columns; ++k) gamma[k] = job.coefficients[static_cast<std::size_t>(k) * job.sources + j];
        Pack r[d];
        Pack squared{};
        for (int l = 0; l < d; ++l) {
          r[l] = y[l] - job.position[static_cast<std::size_t>(l) * job.sources + j];
          squared += r[l] * r[l];
        }
        // Below -729 the Gaussian is exactly 0; what it multiplies stays finite, but NaN is passed on.
        Pack e = squared * -job.sigma;
        e = e < -729.0 ? broadcast(-729.0) : e;
        add_pair<matrix, d, columns, rows>(r, e, job.sigma, gamma, partial);
      }
      for (int i = 0; i < rows; ++i) total[i] += partial[i];
    }
    for (int i = 0; i < rows; ++i)
      store(job.values + static_cast<std::size_t>(i) * target_group + first, total[i] * factor);
  }
}

}  // namespace
extern const PairsKernels pairs_kernels;
const PairsKernels pairs_kernels = {{{sum_pairs<field_matrix, 2, 2, 2>, sum_pairs<field_matrix, 3, 3, 3>},
                                     {sum_pairs<curl_matrix, 2, 1, 2>, sum_pairs<curl_matrix, 3, 3, 3>},
                                     {sum_pairs<vorticity_matrix, 2, 1, 1>, sum_pairs<vorticity_matrix, 3, 3, 3>}}};

}  // namespace gaussdrift::detail::CORE_ISA
