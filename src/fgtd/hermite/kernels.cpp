// The kernels of `hermite`: expansions at targets, and tables of Hermite functions for its grids; see
// core/simd/vector.hpp for what may stand here.
#include "core/simd/functions.hpp"
#include "fgtd/kernels/contract.hpp"
#include "fgtd/kernels/set.hpp"

namespace fgtd::detail::CORE_ISA {
namespace {

template <int d, int vectors>
void expansion_at(const ExpansionJob& job, std::size_t first) {
  constexpr std::size_t width = vectors * lanes;
  const std::size_t p = static_cast<std::size_t>(job.terms);
  std::size_t moments_size = 1;
  for (int l = 0; l < d; ++l) moments_size *= p;

  // scratch: h~_n of every axis, then g_{a,b} for every axis and a >= 1
  double* hermite[d];
  double* derived[d];
  double* free = job.scratch;
  for (int l = 0; l < d; ++l) {
    hermite[l] = free;
    free += (p + static_cast<std::size_t>(job.highest[l])) * width;
    derived[l] = free;
    free += p * static_cast<std::size_t>(job.highest[l]) * width;
  }

  for (std::size_t near = 0; near < job.boxes; ++near) {
    const std::size_t box = job.box[near];
    Vector t[d][vectors];
    Vector gap[vectors] = {};  // squared distance to the box
    for (int l = 0; l < d; ++l)
      for (int v = 0; v < vectors; ++v) {
        const std::size_t lane = first + static_cast<std::size_t>(v) * lanes;
        const double centre = job.centre[box * d + static_cast<std::size_t>(l)];
        t[l][v] = (load(job.target + static_cast<std::size_t>(l) * group_size + lane) - centre) * job.root_sigma;
        const Vector beyond = (t[l][v] < 0.0 ? -t[l][v] : t[l][v]) - job.half_side;
        gap[v] += select(reinterpret_cast<Bits>(beyond > 0.0), beyond * beyond);
        t[l][v] = clamp(t[l][v], 1e3);  // h~_0 is 0 there, and the recurrence keeps it
      }
    Bits any{};
    for (int v = 0; v < vectors; ++v) any |= reinterpret_cast<Bits>(gap[v] <= job.squared_reach);
    unsigned long long some = 0;
    for (std::size_t i = 0; i < lanes; ++i) some |= any[i];
    if (some == 0) continue;

    for (int l = 0; l < d; ++l)
      for (int v = 0; v < vectors; ++v) {
        Vector previous{};
        Vector current = exp_interpolated(-(t[l][v] * t[l][v]));
        if (l == 0) current = select(reinterpret_cast<Bits>(gap[v] <= job.squared_reach), current);
        double* row = hermite[l] + static_cast<std::size_t>(v) * lanes;
        const int highest = job.terms - 1 + job.highest[l];
        store(row, current);
        for (int n = 0; n < highest; ++n) {
          const Vector next = t[l][v] * job.recurrence.up[n] * current - previous * job.recurrence.back[n];
          previous = current;
          current = next;
          row += width;
          store(row, current);
        }
        for (int a = 1; a <= job.highest[l]; ++a) {
          const double* from = hermite[l] + static_cast<std::size_t>(a) * width + static_cast<std::size_t>(v) * lanes;
          double* to = derived[l] + static_cast<std::size_t>(a - 1) * p * width + static_cast<std::size_t>(v) * lanes;
          for (std::size_t b = 0; b < p; ++b)
            store(to + b * width, load(from + b * width) * job.binomial_root[static_cast<std::size_t>(a) * p + b]);
        }
      }

    for (std::size_t derivative = 0; derivative < job.derivatives; ++derivative) {
      const double* g[d];
      for (int l = 0; l < d; ++l) {
        const int a = job.order[derivative * max_dimension + static_cast<std::size_t>(l)];
        g[l] = a == 0 ? hermite[l] : derived[l] + static_cast<std::size_t>(a - 1) * p * width;
      }
      for (std::size_t k = 0; k < job.columns; ++k) {
        const double* moments = job.moments + (box * job.columns + k) * moments_size;
        Vector sum[vectors];
        contract<d - 1, vectors>(p, moments, g, sum);
        double* out = job.out + (derivative * job.columns + k) * group_size + first;
        for (int v = 0; v < vectors; ++v)
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
  switch (job.dimension) {
    case 1:
      return expansion_in<1>(job);
    case 2:
      return expansion_in<2>(job);
    case 3:
      return expansion_in<3>(job);
    default:
      return expansion_in<4>(job);
  }
}

void table(const TableJob& job) {
  for (std::size_t i = 0; i < job.count; i += lanes) {
    const Vector t = clamp(load(job.t + i), 1e3);
    Vector previous{};
    Vector current = exp_interpolated(-(t * t));
    store(job.rows + i, current);
    for (int n = 0; n + 1 < job.orders; ++n) {
      const Vector next = t * job.recurrence.up[n] * current - previous * job.recurrence.back[n];
      previous = current;
      current = next;
      store(job.rows + static_cast<std::size_t>(n + 1) * job.stride + i, current);
    }
  }
}

}  // namespace fgtd::detail::CORE_ISA
