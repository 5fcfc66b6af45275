// Every pair of a source and a target; see core/simd/pack.hpp for what may stand here.
#include "rbf/kernels/profile.hpp"
#include "rbf/kernels/set.hpp"

namespace rbf::detail::CORE_ISA {
namespace {

constexpr std::size_t source_chunk = 256;  // partial sums of so many terms, then added: rounding grows with N/256 + 256
constexpr std::size_t packs = 2 * lanes <= group_size ? 2 : 1;  // of targets in registers

template <int d, Kernel kernel, int order>
void pairs_of(const PairsJob& job) {
  constexpr std::size_t outputs = derivatives_up_to(d, order);
  const Shape shape = shape_of<kernel>(job.shape);
  for (std::size_t first = 0; first < group_size; first += packs * lanes) {
    Pack y[d][packs];
    for (int l = 0; l < d; ++l)
      for (std::size_t v = 0; v < packs; ++v)
        y[l][v] = load(job.target + static_cast<std::size_t>(l) * group_size + first + v * lanes);
    Pack total[outputs][packs] = {};
    for (std::size_t begin = 0; begin < job.sources; begin += source_chunk) {
      const std::size_t end = begin + source_chunk < job.sources ? begin + source_chunk : job.sources;
      Pack partial[outputs][packs] = {};
      for (std::size_t j = begin; j < end; ++j) {
        const double weight = job.weights[j];
        for (std::size_t v = 0; v < packs; ++v) {
          Pack distance[d], s{};
          for (int l = 0; l < d; ++l) {
            distance[l] = y[l][v] - job.position[static_cast<std::size_t>(l) * job.sources + j];
            s += distance[l] * distance[l];
          }
          const Profile f = profile<kernel, order>(s, shape);
          partial[0][v] += f.value * weight;
          if constexpr (order >= 1) {
            const Pack slope = f.slope * (2 * weight), curvature = f.curvature * (4 * weight);
            std::size_t output = 1;
            for (int l = 0; l < d; ++l) partial[output++][v] += slope * distance[l];
            if constexpr (order >= 2)
              for (int l = 0; l < d; ++l) {
                const Pack across = curvature * distance[l];
                for (int m = l; m < d; ++m) {
                  partial[output][v] += across * distance[m];
                  if (m == l) partial[output][v] += slope;
                  ++output;
                }
              }
          }
        }
      }
      for (std::size_t output = 0; output < outputs; ++output)
        for (std::size_t v = 0; v < packs; ++v) total[output][v] += partial[output][v];
    }
    for (std::size_t output = 0; output < outputs; ++output)
      for (std::size_t v = 0; v < packs; ++v)
        store(job.out + output * group_size + first + v * lanes, total[output][v]);
  }
}

}  // namespace

void pairs(const PairsJob& job) {
  in_instance(job, [&]<int d, Kernel kernel, int order>() { pairs_of<d, kernel, order>(job); });
}

}  // namespace rbf::detail::CORE_ISA
