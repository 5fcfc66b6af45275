// Harmonic polynomials of harmonics.hpp at many points; see core/simd/pack.hpp for what may stand here.
#include "core/simd/functions.hpp"
#include "farfield/kernels/set.hpp"

namespace farfield::detail::CORE_ISA {
namespace {

constexpr std::size_t packs = 2;  // of points at a time
constexpr std::size_t group = packs * lanes;

/// Calls use(k, values) for every function k, values being those at `packs` packs of points.
template <class Use>
CORE_INLINE void for_each_function(int degree, const Pack (*t)[3], const Use& use) {
  Pack re[packs], im[packs];
  for (std::size_t v = 0; v < packs; ++v) {
    re[v] = broadcast(1);
    im[v] = Pack{};
  }
  use(0, re);
  for (int k = 1; k <= degree; ++k) {
    for (std::size_t v = 0; v < packs; ++v) {
      const Pack next = re[v] * t[v][0] - im[v] * t[v][1];
      im[v] = re[v] * t[v][1] + im[v] * t[v][0];
      re[v] = next;
    }
    use(static_cast<std::size_t>(2 * k - 1), re);
    use(static_cast<std::size_t>(2 * k), im);
  }
}

template <class Use>
CORE_INLINE void for_each_function(int degree, const Pack (*t)[3], const double* up, const double* back,
                                   const Use& use) {
  Pack squared[packs], re[packs], im[packs];
  for (std::size_t v = 0; v < packs; ++v) {
    squared[v] = t[v][0] * t[v][0] + t[v][1] * t[v][1] + t[v][2] * t[v][2];
    re[v] = broadcast(1);
    im[v] = Pack{};
  }
  for (int m = 0; m <= degree; ++m) {
    Pack cosine[packs], sine[packs], last_cosine[packs] = {}, last_sine[packs] = {};
    for (std::size_t v = 0; v < packs; ++v) {
      cosine[v] = re[v];
      sine[v] = im[v];
    }
    use(static_cast<std::size_t>(m * m + 2 * m), cosine);
    if (m > 0) use(static_cast<std::size_t>(m * m), sine);
    for (int l = m + 1; l <= degree; ++l) {
      const double a = up[l * (degree + 1) + m], b = back[l * (degree + 1) + m];
      for (std::size_t v = 0; v < packs; ++v) {
        const Pack forward = t[v][2] * a, backward = squared[v] * b;
        const Pack c = forward * cosine[v] - backward * last_cosine[v];
        last_cosine[v] = cosine[v];
        cosine[v] = c;
        const Pack s = forward * sine[v] - backward * last_sine[v];
        last_sine[v] = sine[v];
        sine[v] = s;
      }
      use(static_cast<std::size_t>(l * l + l + m), cosine);
      if (m > 0) use(static_cast<std::size_t>(l * l + l - m), sine);
    }
    for (std::size_t v = 0; v < packs; ++v) {
      const Pack next = (re[v] * t[v][0] - im[v] * t[v][1]) * 0.5;
      im[v] = (re[v] * t[v][1] + im[v] * t[v][0]) * 0.5;
      re[v] = next;
    }
  }
}

template <class Job>
CORE_INLINE void local_coordinates(const Job& job, std::size_t first, Pack (*t)[3]) {
  for (std::size_t v = 0; v < packs; ++v)
    for (int l = 0; l < job.dimension; ++l)
      t[v][l] = (load(job.point[l] + first + v * lanes) - job.centre[l]) * job.scale;
}

template <int outputs, int d>
CORE_INLINE void expand(const ExpansionJob& job, std::size_t first) {
  Pack t[packs][3];
  local_coordinates(job, first, t);
  Pack sum[4][packs] = {};
  constexpr int begin = outputs == d ? 1 : 0;  // without the potential
  const auto use = [&](std::size_t k, const Pack* value) {
    for (int o = begin; o < 1 + d; ++o) {
      const double c = job.coefficient[o][k];
      for (std::size_t v = 0; v < packs; ++v) sum[o][v] += value[v] * c;
    }
  };
  if constexpr (d == 2) {
    for_each_function(job.degree, t, use);
  } else {
    for_each_function(job.degree, t, job.up, job.back, use);
  }
  for (std::size_t v = 0; v < packs; ++v)
    for (std::size_t i = 0; i < lanes; ++i) {
      const std::size_t at = first + v * lanes + i;
      if (at >= job.range.end) return;
      if constexpr (begin == 0) job.potential[at] += sum[0][v][i];
      for (int l = 0; l < d; ++l) job.field[l][at] += sum[1 + l][v][i] * job.field_scale;
    }
}

}  // namespace

void moments(const MomentsJob& job) {
  const std::size_t n = static_cast<std::size_t>(job.degree);
  const std::size_t count = job.dimension == 2 ? 2 * n + 1 : (n + 1) * (n + 1);
  for (std::size_t i = 0; i < count * lanes; ++i) job.scratch[i] = 0;
  for (std::size_t first = job.range.begin; first < job.range.end; first += group) {
    Pack t[packs][3], charge[packs] = {};
    local_coordinates(job, first, t);
    for (std::size_t v = 0; v < packs; ++v)
      for (std::size_t i = 0; i < lanes; ++i) {
        const std::size_t at = first + v * lanes + i;
        if (at < job.range.end) {
          charge[v][i] = job.charge[at];
        } else {  // a point of another cluster, where polynomials may be infinite
          for (int l = 0; l < job.dimension; ++l) t[v][l][i] = 0;
        }
      }
    const auto use = [&](std::size_t k, const Pack* value) {
      double* const to = job.scratch + k * lanes;
      Pack sum = load(to);
      for (std::size_t v = 0; v < packs; ++v) sum += value[v] * charge[v];
      store(to, sum);
    };
    if (job.dimension == 2) {
      for_each_function(job.degree, t, use);
    } else {
      for_each_function(job.degree, t, job.up, job.back, use);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < lanes; ++i) sum += job.scratch[k * lanes + i];
    job.moments[k] = sum;
  }
}

void expansion(const ExpansionJob& job) {
  for (std::size_t first = job.range.begin; first < job.range.end; first += group) {
    if (job.dimension == 2) {
      job.potential ? expand<3, 2>(job, first) : expand<2, 2>(job, first);
    } else {
      job.potential ? expand<4, 3>(job, first) : expand<3, 3>(job, first);
    }
  }
}

}  // namespace farfield::detail::CORE_ISA
