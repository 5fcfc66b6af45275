// Close pairs, one target at a time, sources in the lanes; see core/simd/pack.hpp for what may stand here.
#include "rbf/kernels/profile.hpp"
#include "rbf/kernels/set.hpp"

namespace rbf::detail::CORE_ISA {
namespace {

/// Even and odd powers apart: two chains of operations that do not wait for each other.
CORE_INLINE Pack polynomial(const PolynomialView& of, Pack x) {
  const Pack square = x * x;
  Pack even{}, odd{};
  for (std::size_t n = of.count; n > 0; n -= 2) {  // count is even
    even = even * square + of.coefficient[n - 2];
    odd = odd * square + of.coefficient[n - 1];
  }
  return odd * x + even;
}

CORE_INLINE double sum_of_lanes(Pack x) {
  double sum = 0;
  for (std::size_t i = 0; i < lanes; ++i) sum += x[i];
  return sum;
}

/// Lanes 0, 1, 2, ...
CORE_INLINE Bits lane_numbers() {
  Bits numbers{};
  for (std::size_t i = 0; i < lanes; ++i) numbers[i] = i;
  return numbers;
}

template <int d, Kernel kernel, int order>
void near_of(const NearJob& job) {
  constexpr std::size_t outputs = derivatives_up_to(d, order);
  const Shape shape = shape_of<kernel>(job.shape);
  const double squared = job.radius * job.radius, twice_inverse = 2 / squared;
  const Bits number = lane_numbers();
  Pack total[outputs] = {};
  for (std::size_t run = 0; run < job.run_count; ++run)
    for (std::size_t j = job.runs[run].begin; j < job.runs[run].end; j += lanes) {
      Pack distance[d], s{};
      for (int l = 0; l < d; ++l) {
        distance[l] = job.target[l] - load(job.position + static_cast<std::size_t>(l) * job.stride + j);
        s += distance[l] * distance[l];
      }
      const Bits close = reinterpret_cast<Bits>(s < squared) &
                         reinterpret_cast<Bits>(number < static_cast<unsigned long long>(job.runs[run].end - j));
      if (!any_true(reinterpret_cast<Signed>(close))) continue;
      s = select(close, s);
      const Profile f = profile<kernel, order>(s, shape);
      const Pack x = s * twice_inverse - 1.0, weight = select(close, load(job.weights + j));
      total[0] += (f.value - polynomial(job.smooth[0], x)) * weight;
      if constexpr (order >= 1) {
        const Pack slope = (f.slope - polynomial(job.smooth[1], x)) * (weight * 2.0);
        std::size_t output = 1;
        for (int l = 0; l < d; ++l) total[output++] += slope * distance[l];
        if constexpr (order >= 2) {
          const Pack curvature = (f.curvature - polynomial(job.smooth[2], x)) * (weight * 4.0);
          for (int l = 0; l < d; ++l) {
            const Pack across = curvature * distance[l];
            for (int m = l; m < d; ++m) {
              total[output] += across * distance[m];
              if (m == l) total[output] += slope;
              ++output;
            }
          }
        }
      }
    }
  for (std::size_t output = 0; output < outputs; ++output) job.out[output] = sum_of_lanes(total[output]);
}

}  // namespace

void near(const NearJob& job) {
  in_instance(job, [&]<int d, Kernel kernel, int order>() { near_of<d, kernel, order>(job); });
}

}  // namespace rbf::detail::CORE_ISA
