// The kernel of `outer`: rows of one-dimensional Hermite functions over the nodes of a window, multiplied as matrices;
// see core/simd/vector.hpp for what may stand here.
#include "core/simd/vector.hpp"
#include "fgtd/cells/job.hpp"
#include "fgtd/kernels/power.hpp"
#include "fgtd/kernels/product.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

/// exp(-t^2) by a polynomial of one of the degrees of `exponentials`.
CORE_INLINE Vector gaussian(Vector t, int degree) {
  const Vector squared = t * t;
  constexpr double limit = 690;  // 2^-1000
  switch (degree) {
    case 4:
      return power_of_half<4>(squared, log2_e, limit);
    case 6:
      return power_of_half<6>(squared, log2_e, limit);
    case 8:
      return power_of_half<8>(squared, log2_e, limit);
    default:
      return power_of_half<11>(squared, log2_e, limit);
  }
}

/// rows[n stride] = h~_n(t), n = 0 .. highest.
CORE_INLINE void hermite_rows(Vector t, int degree, int highest, const Recurrence& recurrence, double* rows,
                              std::size_t stride) {
  t = clamp(t, 27.0);
  Vector previous{}, current = gaussian(t, degree);
  store(rows, current);
  for (int n = 0; n < highest; ++n) {
    const Vector next = t * recurrence.up[n] * current - previous * recurrence.back[n];
    previous = current;
    current = next;
    rows += stride;
    store(rows, current);
  }
}

constexpr std::size_t up_to_lanes(std::size_t n) { return (n + lanes - 1) / lanes * lanes; }

template <int d>
void outer_in(const OuterJob& job) {
  const std::size_t sources = job.sources, depth = up_to_lanes(sources);
  double* free = job.scratch;
  const auto take = [&free](std::size_t size) {
    double* taken = free;
    free += size;
    return taken;
  };

  // first[n][p][node]: rows of the first axis; vectors run over nodes.
  const std::size_t width = up_to_lanes(job.nodes[0]), plane = sources * width;
  double* node = take(width);
  for (std::size_t i = 0; i < width; ++i) node[i] = job.node[0][i < job.nodes[0] ? i : job.nodes[0] - 1];
  double* first = take(plane * static_cast<std::size_t>(job.highest[0] + 1));
  for (std::size_t p = 0; p < sources; ++p)
    for (std::size_t i = 0; i < width; i += lanes)
      hermite_rows((load(node + i) - job.position[p]) * job.root_sigma, job.degree, job.highest[0], job.recurrence,
                   first + p * width + i, plane);

  // upper[l][n][node][p]: of the other axes; vectors run over sources, padded by repeating the last.
  double* upper[d];
  for (int l = 1; l < d; ++l) {
    const double* position = job.position + static_cast<std::size_t>(l) * job.stride;
    double* x = take(depth);
    for (std::size_t p = 0; p < depth; ++p) x[p] = position[p < sources ? p : sources - 1];
    const std::size_t table = job.nodes[l] * depth;
    upper[l] = take(table * static_cast<std::size_t>(job.highest[l] + 1));
    for (std::size_t i = 0; i < job.nodes[l]; ++i)
      for (std::size_t p = 0; p < depth; p += lanes)
        hermite_rows((job.node[l][i] - load(x + p)) * job.root_sigma, job.degree, job.highest[l], job.recurrence,
                     upper[l] + i * depth + p, table);
  }

  double* weight = take(depth);
  double* left = take((d > 1 ? job.nodes[1] : 1) * depth);
  for (std::size_t i3 = 0; i3 < (d > 3 ? job.nodes[3] : 1); ++i3)
    for (std::size_t i2 = 0; i2 < (d > 2 ? job.nodes[2] : 1); ++i2) {
      // The part of the window that this slab leaves within reach of the group's bounding box.
      std::size_t from[2] = {0, 0}, to[2] = {job.nodes[0], d > 1 ? job.nodes[1] : 1};
      if constexpr (d > 2) {
        double squared = job.reach * job.reach;
        for (int l = 2; l < d; ++l) {
          const double y = job.node[l][l == 2 ? i2 : i3];
          const double apart = y < job.low[l] ? job.low[l] - y : y > job.high[l] ? y - job.high[l] : 0;
          squared -= apart * apart;
        }
        if (squared < 0) continue;
        const double reach = __builtin_sqrt(squared);
        for (int l = 0; l < 2; ++l) {
          while (from[l] < to[l] && job.node[l][from[l]] < job.low[l] - reach) ++from[l];
          while (from[l] < to[l] && job.node[l][to[l] - 1] > job.high[l] + reach) --to[l];
        }
        from[0] = from[0] / lanes * lanes;
        to[0] = up_to_lanes(to[0]) < job.nodes[0] ? up_to_lanes(to[0]) : job.nodes[0];
        if (from[0] >= to[0] || from[1] >= to[1]) continue;
      }
      double* out = job.out + from[0] * job.step[0];
      if (d > 1) out += from[1] * job.step[1];
      if (d > 2) out += i2 * job.step[2];
      if (d > 3) out += i3 * job.step[3];
      const std::size_t rows = to[1] - from[1];

      for (std::size_t q = 0; q < job.combinations; ++q)
        for (std::size_t k = 0; k < job.columns; ++k) {
          double* here = out + (q * job.columns + k) * job.output_stride;
          for (std::size_t bundle = job.first_bundle[q]; bundle < job.first_bundle[q + 1]; ++bundle) {
            for (std::size_t part = job.first_part[bundle]; part < job.first_part[bundle + 1]; ++part) {
              const int* order = job.order + part * max_dimension;
              for (std::size_t p = 0; p < depth; ++p)
                weight[p] = p < sources ? job.weights[k * job.stride + p] * job.factor[part] : 0.0;
              for (int l = 2; l < d; ++l) {
                const double* row =
                    upper[l] + (static_cast<std::size_t>(order[l]) * job.nodes[l] + (l == 2 ? i2 : i3)) * depth;
                for (std::size_t p = 0; p < depth; p += lanes) store(weight + p, load(weight + p) * load(row + p));
              }
              const bool fresh = part == job.first_part[bundle];
              for (std::size_t i = 0; i < rows; ++i)
                for (std::size_t p = 0; p < depth; p += lanes) {
                  Vector value = load(weight + p);
                  if constexpr (d > 1)
                    value *=
                        load(upper[1] + (static_cast<std::size_t>(order[1]) * job.nodes[1] + from[1] + i) * depth + p);
                  double* at = left + i * depth + p;
                  store(at, fresh ? value : load(at) + value);
                }
            }
            multiply_add(rows, sources, to[0] - from[0], left, depth,
                         first + static_cast<std::size_t>(job.bundle_order[bundle]) * plane + from[0], width, here,
                         d > 1 ? job.step[1] : 0);
          }
        }
    }
}

}  // namespace

void outer(const OuterJob& job) {
  switch (job.dimension) {
    case 1:
      return outer_in<1>(job);
    case 2:
      return outer_in<2>(job);
    case 3:
      return outer_in<3>(job);
    default:
      return outer_in<4>(job);
  }
}

}  // namespace fgtd::detail::CORE_ISA
