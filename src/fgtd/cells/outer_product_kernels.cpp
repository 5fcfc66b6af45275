// The kernel of `outer_product`: rows of one-dimensional Hermite functions over the nodes of a window, multiplied as
// matrices; see core/simd/pack.hpp for what may stand here.
#include "core/simd/pack.hpp"
#include "fgtd/cells/job.hpp"
#include "fgtd/kernels/dimensions.hpp"
#include "fgtd/kernels/power.hpp"
#include "fgtd/kernels/product.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

/// exp(-t^2) by a polynomial of one of the degrees of `exponentials`.
CORE_INLINE Pack gaussian(Pack t, int degree) {
  const Pack squared = t * t;
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
CORE_INLINE void hermite_rows(Pack t, int degree, int highest, const Recurrence& recurrence, double* rows,
                              std::size_t stride) {
  t = clamp(t, 27.0);
  Pack previous{}, current = gaussian(t, degree);
  store(rows, current);
  for (int n = 0; n < highest; ++n) {
    const Pack next = t * recurrence.up[n] * current - previous * recurrence.back[n];
    previous = current;
    current = next;
    rows += stride;
    store(rows, current);
  }
}

constexpr std::size_t up_to_lanes(std::size_t n) { return (n + lanes - 1) / lanes * lanes; }

/// Rows of one-dimensional Hermite functions of all axes, and room for the left factor of a product.
template <int d>
struct Rows {
  std::size_t depth;       // sources, up to whole packs
  std::size_t width;       // nodes of the first axis, up to whole packs
  std::size_t plane;       // numbers of the first axis for one order
  const double* first;     // [order][source][node]; packs run over nodes
  const double* upper[d];  // [order][node][source] of the other axes; packs run over sources, the last one repeated
  double* weight;          // [depth]
  double* left;            // [nodes of the second axis][depth]
};

template <int d>
CORE_INLINE Rows<d> make_rows(const OuterProductJob& job) {
  const std::size_t sources = job.sources, depth = up_to_lanes(sources);
  double* free = job.scratch;
  const auto take = [&free](std::size_t size) {
    double* taken = free;
    free += size;
    return taken;
  };
  Rows<d> rows{};
  rows.depth = depth;

  const std::size_t width = up_to_lanes(job.nodes[0]), plane = sources * width;
  rows.width = width;
  rows.plane = plane;
  double* node = take(width);
  for (std::size_t i = 0; i < width; ++i) node[i] = job.node[0][i < job.nodes[0] ? i : job.nodes[0] - 1];
  double* first = take(plane * static_cast<std::size_t>(job.highest[0] + 1));
  for (std::size_t p = 0; p < sources; ++p)
    for (std::size_t i = 0; i < width; i += lanes)
      hermite_rows((load(node + i) - job.position[p]) * job.root_sigma, job.degree, job.highest[0], job.recurrence,
                   first + p * width + i, plane);
  rows.first = first;

  for (int l = 1; l < d; ++l) {
    const double* position = job.position + static_cast<std::size_t>(l) * job.stride;
    double* x = take(depth);
    for (std::size_t p = 0; p < depth; ++p) x[p] = position[p < sources ? p : sources - 1];
    const std::size_t table = job.nodes[l] * depth;
    double* upper = take(table * static_cast<std::size_t>(job.highest[l] + 1));
    for (std::size_t i = 0; i < job.nodes[l]; ++i)
      for (std::size_t p = 0; p < depth; p += lanes)
        hermite_rows((job.node[l][i] - load(x + p)) * job.root_sigma, job.degree, job.highest[l], job.recurrence,
                     upper + i * depth + p, table);
    rows.upper[l] = upper;
  }
  rows.weight = take(depth);
  rows.left = take((d > 1 ? job.nodes[1] : 1) * depth);
  return rows;
}

/// Nodes of the third and fourth axis, and what they leave of the window along the first two.
struct Slab {
  std::size_t upper[2];  // indices of the nodes
  std::size_t from[2], to[2];
};

/// Narrows the slab to what is within reach of the group's bounding box; false if nothing is.
template <int d>
CORE_INLINE bool narrow(const OuterProductJob& job, Slab& slab) {
  double squared = job.reach * job.reach;
  for (int l = 2; l < d; ++l) {
    const double y = job.node[l][slab.upper[l - 2]];
    const double apart = y < job.low[l] ? job.low[l] - y : y > job.high[l] ? y - job.high[l] : 0;
    squared -= apart * apart;
  }
  if (squared < 0) return false;
  const double reach = __builtin_sqrt(squared);
  for (int l = 0; l < 2; ++l) {
    while (slab.from[l] < slab.to[l] && job.node[l][slab.from[l]] < job.low[l] - reach) ++slab.from[l];
    while (slab.from[l] < slab.to[l] && job.node[l][slab.to[l] - 1] > job.high[l] + reach) --slab.to[l];
  }
  slab.from[0] = slab.from[0] / lanes * lanes;
  slab.to[0] = up_to_lanes(slab.to[0]) < job.nodes[0] ? up_to_lanes(slab.to[0]) : job.nodes[0];
  return slab.from[0] < slab.to[0] && slab.from[1] < slab.to[1];
}

/// left[node of the second axis][source]: weights times the rows of all axes but the first, summed over the parts of a
/// bundle, which have the first axis's order in common.
template <int d>
CORE_INLINE void make_left(const OuterProductJob& job, const Rows<d>& rows, const Slab& slab, std::size_t k,
                           std::size_t bundle) {
  const std::size_t sources = job.sources, depth = rows.depth;
  double* const weight = rows.weight;
  for (std::size_t part = job.first_part[bundle]; part < job.first_part[bundle + 1]; ++part) {
    const int* order = job.order + part * max_dimension;
    for (std::size_t p = 0; p < depth; ++p)
      weight[p] = p < sources ? job.weights[k * job.stride + p] * job.factor[part] : 0.0;
    for (int l = 2; l < d; ++l) {
      const double* row =
          rows.upper[l] + (static_cast<std::size_t>(order[l]) * job.nodes[l] + slab.upper[l - 2]) * depth;
      for (std::size_t p = 0; p < depth; p += lanes) store(weight + p, load(weight + p) * load(row + p));
    }
    const bool fresh = part == job.first_part[bundle];
    for (std::size_t i = 0; i < slab.to[1] - slab.from[1]; ++i)
      for (std::size_t p = 0; p < depth; p += lanes) {
        Pack value = load(weight + p);
        if constexpr (d > 1)
          value *=
              load(rows.upper[1] + (static_cast<std::size_t>(order[1]) * job.nodes[1] + slab.from[1] + i) * depth + p);
        double* at = rows.left + i * depth + p;
        store(at, fresh ? value : load(at) + value);
      }
  }
}

template <int d>
void outer_product_in(const OuterProductJob& job) {
  const Rows<d> rows = make_rows<d>(job);
  for (std::size_t i3 = 0; i3 < (d > 3 ? job.nodes[3] : 1); ++i3)
    for (std::size_t i2 = 0; i2 < (d > 2 ? job.nodes[2] : 1); ++i2) {
      Slab slab{{i2, i3}, {0, 0}, {job.nodes[0], d > 1 ? job.nodes[1] : 1}};
      if constexpr (d > 2) {
        if (!narrow<d>(job, slab)) continue;
      }
      double* out = job.out + slab.from[0] * job.step[0];
      if (d > 1) out += slab.from[1] * job.step[1];
      if (d > 2) out += i2 * job.step[2];
      if (d > 3) out += i3 * job.step[3];
      for (std::size_t q = 0; q < job.combinations; ++q)
        for (std::size_t k = 0; k < job.columns; ++k)
          for (std::size_t bundle = job.first_bundle[q]; bundle < job.first_bundle[q + 1]; ++bundle) {
            make_left<d>(job, rows, slab, k, bundle);
            multiply_add(slab.to[1] - slab.from[1], job.sources, slab.to[0] - slab.from[0], rows.left, rows.depth,
                         rows.first + static_cast<std::size_t>(job.bundle_order[bundle]) * rows.plane + slab.from[0],
                         rows.width, out + (q * job.columns + k) * job.output_stride, d > 1 ? job.step[1] : 0);
          }
    }
}

}  // namespace

void outer_product(const OuterProductJob& job) {
  in_dimension(job.dimension, [&](auto dimension) { outer_product_in<dimension.d>(job); });
}

}  // namespace fgtd::detail::CORE_ISA
