// Hands groups of targets to the kernels.
#include "field/gaussians/pairs.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "core/dispatch.hpp"
#include "field/gaussians/pairs_job.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

namespace detail {
CORE_DECLARE_TABLES(PairsKernels, pairs_kernels)

namespace {

const PairsKernels& fastest_kernels() {
  static const PairsKernels& fastest = *core::supported<PairsKernels>(CORE_TABLES(pairs_kernels)).back();
  return fastest;
}

}  // namespace
}  // namespace detail

void sum_gaussian_pairs(const GaussianPairs& pairs, int threads) {
  using detail::target_group;
  const auto kernel = detail::fastest_kernels()
                          .sum[static_cast<std::size_t>(pairs.matrix)][static_cast<std::size_t>(pairs.dimension - 2)];
  const auto rows = static_cast<std::size_t>(gaussian_rows(pairs.matrix, pairs.dimension));
  const auto dimension = static_cast<std::size_t>(pairs.dimension);
  const std::size_t groups = (pairs.targets + target_group - 1) / target_group;
  constexpr std::size_t groups_a_piece = 4;
  const base::Pieces pieces((groups + groups_a_piece - 1) / groups_a_piece,
                            2e-9 * static_cast<double>(pairs.targets) * static_cast<double>(pairs.sources));
  base::parallel_for(pieces, threads, [&](std::size_t piece) {
    double target[max_dimension * target_group], values[max_dimension * target_group];
    for (std::size_t group = piece * groups_a_piece; group < std::min(groups, (piece + 1) * groups_a_piece); ++group) {
      const std::size_t begin = group * target_group, size = std::min(target_group, pairs.targets - begin);
      for (std::size_t l = 0; l < dimension; ++l)
        for (std::size_t i = 0; i < target_group; ++i)
          target[l * target_group + i] = pairs.target[l * pairs.target_stride + begin + std::min(i, size - 1)];
      kernel({pairs.sigma, pairs.sources, pairs.position, pairs.coefficients, target, values});
      for (std::size_t k = 0; k < rows; ++k)
        std::copy_n(values + k * target_group, size, pairs.values + k * pairs.value_stride + begin);
    }
  });
}

}  // namespace gaussdrift
