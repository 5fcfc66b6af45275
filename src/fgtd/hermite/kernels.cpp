// The kernels of `hermite`: expansions at targets, and tables of Hermite functions for its grids; see
// core/simd/pack.hpp for what may stand here.
#include "core/simd/functions.hpp"
#include "fgtd/kernels/contract.hpp"
#include "fgtd/kernels/dimensions.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

/// Tables of one box at some packs of targets: h~_n of every axis, then g_{a,b} for every axis and a >= 1.
template <int d, int packs>
struct ExpansionTables {
  static constexpr std::size_t width = packs * lanes;
  double* hermite[d];
  double* derived[d];

  CORE_INLINE explicit ExpansionTables(const ExpansionJob& job) {
    const std::size_t p = static_cast<std::size_t>(job.terms);
    double* free = job.scratch;
    for (int l = 0; l < d; ++l) {
      hermite[l] = free;
      free += (p + static_cast<std::size_t>(job.highest[l])) * width;
      derived[l] = free;
      free += p * static_cast<std::size_t>(job.highest[l]) * width;
    }
  }

  /// Of axis l at t, in place v; `current` is h~_0.
  CORE_INLINE void fill(const ExpansionJob& job, int l, int v, Pack t, Pack current) const {
    const std::size_t p = static_cast<std::size_t>(job.terms), place = static_cast<std::size_t>(v) * lanes;
    Pack previous{};
    double* row = hermite[l] + place;
    const int highest = job.terms - 1 + job.highest[l];
    store(row, current);
    for (int n = 0; n < highest; ++n) {
      const Pack next = t * job.recurrence.up[n] * current - previous * job.recurrence.back[n];
      previous = current;
      current = next;
      row += width;
      store(row, current);
    }
    for (int a = 1; a <= job.highest[l]; ++a) {
      const double* from = hermite[l] + static_cast<std::size_t>(a) * width + place;
      double* to = derived[l] + static_cast<std::size_t>(a - 1) * p * width + place;
      for (std::size_t b = 0; b < p; ++b)
        store(to + b * width, load(from + b * width) * job.binomial_root[static_cast<std::size_t>(a) * p + b]);
    }
  }

  /// g_{a,b} of axis l, for all b.
  CORE_INLINE const double* factors(const ExpansionJob& job, int l, int a) const {
    return a == 0 ? hermite[l] : derived[l] + static_cast<std::size_t>((a - 1) * job.terms) * width;
  }
};

template <int d, int packs>
void expansion_at(const ExpansionJob& job, std::size_t first) {
  const std::size_t p = static_cast<std::size_t>(job.terms);
  std::size_t moments_size = 1;
  for (int l = 0; l < d; ++l) moments_size *= p;
  const ExpansionTables<d, packs> tables(job);

  for (std::size_t near = 0; near < job.boxes; ++near) {
    const std::size_t box = job.box[near];
    Pack t[d][packs];
    Pack gap[packs] = {};  // squared distance to the box
    for (int l = 0; l < d; ++l)
      for (int v = 0; v < packs; ++v) {
        const std::size_t lane = first + static_cast<std::size_t>(v) * lanes;
        const double centre = job.centre[box * d + static_cast<std::size_t>(l)];
        t[l][v] = (load(job.target + static_cast<std::size_t>(l) * group_size + lane) - centre) * job.root_sigma;
        const Pack beyond = (t[l][v] < 0.0 ? -t[l][v] : t[l][v]) - job.half_side;
        gap[v] += select(reinterpret_cast<Bits>(beyond > 0.0), beyond * beyond);
        t[l][v] = clamp(t[l][v], 1e3);  // h~_0 is 0 there, and the recurrence keeps it
      }
    Bits any{};
    for (int v = 0; v < packs; ++v) any |= reinterpret_cast<Bits>(gap[v] <= job.squared_reach);
    unsigned long long some = 0;
    for (std::size_t i = 0; i < lanes; ++i) some |= any[i];
    if (some == 0) continue;

    for (int l = 0; l < d; ++l)
      for (int v = 0; v < packs; ++v) {
        Pack gaussian = exp_interpolated(-(t[l][v] * t[l][v]));
        if (l == 0) gaussian = select(reinterpret_cast<Bits>(gap[v] <= job.squared_reach), gaussian);
        tables.fill(job, l, v, t[l][v], gaussian);
      }

    for (std::size_t derivative = 0; derivative < job.derivatives; ++derivative) {
      const double* g[d];
      for (int l = 0; l < d; ++l)
        g[l] = tables.factors(job, l, job.order[derivative * max_dimension + static_cast<std::size_t>(l)]);
      for (std::size_t k = 0; k < job.columns; ++k) {
        const double* moments = job.moments + (box * job.columns + k) * moments_size;
        Pack sum[packs];
        contract<d - 1, packs>(p, moments, g, sum);
        double* out = job.out + (derivative * job.columns + k) * group_size + first;
        for (int v = 0; v < packs; ++v)
          store(out + static_cast<std::size_t>(v) * lanes, load(out + static_cast<std::size_t>(v) * lanes) + sum[v]);
      }
    }
  }
}

template <int d>
void expansion_in(const ExpansionJob& job) {
  for (std::size_t first = 0; first < job.targets; first += 2 * lanes) {
    if (job.targets - first <= lanes) {
      expansion_at<d, 1>(job, first);
    } else {
      expansion_at<d, 2>(job, first);
    }
  }
}

}  // namespace

void expansion(const ExpansionJob& job) {
  in_dimension(job.dimension, [&](auto dimension) { expansion_in<dimension.d>(job); });
}

void table(const TableJob& job) {
  for (std::size_t i = 0; i < job.count; i += lanes) {
    const Pack t = clamp(load(job.t + i), 1e3);
    Pack previous{};
    Pack current = exp_interpolated(-(t * t));
    store(job.rows + i, current);
    for (int n = 0; n + 1 < job.orders; ++n) {
      const Pack next = t * job.recurrence.up[n] * current - previous * job.recurrence.back[n];
      previous = current;
      current = next;
      store(job.rows + static_cast<std::size_t>(n + 1) * job.stride + i, current);
    }
  }
}

}  // namespace fgtd::detail::CORE_ISA
