// The kernels of named fields: values of u, and whole Runge-Kutta steps in registers (method.md, section 4). See
// core/simd/pack.hpp for what may stand here.
#include "field/named/formula_job.hpp"
#include "field/named/formulas.hpp"

namespace gaussdrift::named::CORE_ISA {

namespace {

/// Calls work(coordinates) for groups of `group` particles. The last, shorter group is filled with its last particle.
template <int axes, std::size_t group, class Work>
CORE_INLINE void for_groups(const FormulaJob& job, const Work& work) {
  std::size_t first = 0;
  for (; first + group <= job.count; first += group) {
    double* x[axes];
    for (int k = 0; k < axes; ++k) x[k] = job.x[k] + first;
    work(x, first, group);
  }
  if (first == job.count) return;
  const std::size_t left = job.count - first;
  double filled[axes][group];
  double* x[axes];
  for (int k = 0; k < axes; ++k) {
    for (std::size_t i = 0; i < group; ++i) filled[k][i] = job.x[k][first + (i < left ? i : left - 1)];
    x[k] = filled[k];
  }
  work(x, first, left);
}

template <class F>
void rates(const FormulaJob& job) {
  const F formula(job.parameters);
  for_groups<F::axes, lanes>(job, [&](double* const* from, std::size_t first, std::size_t count) {
    Pack x[F::axes], u[F::axes];
    for (int k = 0; k < F::axes; ++k) x[k] = load(from[k]);
    formula.velocity(job.of_time, x, u);
    for (int k = 0; k < F::axes; ++k) {
      double* const to = job.u[k] + first;
      if (count == lanes)
        store(to, load(to) + u[k]);
      else
        for (std::size_t i = 0; i < count; ++i) to[i] += u[k][i];
    }
  });
}

constexpr int most_stages = 16;  // of a method that keeps its rates on the stack

/// The classical method of order 4 in registers: each rate serves one next stage, and the sum of all.
template <class F, int wide>
CORE_INLINE void classical_step(const F& formula, const FormulaJob& job, double dt, const double* of_time,
                                Pack (&y)[wide][F::axes]) {
  constexpr int axes = F::axes;
  Pack sum[wide][axes], stage[wide][axes], rate[axes];
  for (int w = 0; w < wide; ++w)
    for (int k = 0; k < axes; ++k) sum[w][k] = stage[w][k] = y[w][k];
  constexpr int below[] = {0, 2, 5};  // a_10, a_21, a_32 in the lower triangle
#pragma GCC unroll 4
  for (int i = 0; i < 4; ++i) {
    const double weight = dt * job.weights[i], next = i < 3 ? dt * job.stage_weights[below[i]] : 0;
    for (int w = 0; w < wide; ++w) {
      formula.velocity(of_time + i * F::time_values, stage[w], rate);
      for (int k = 0; k < axes; ++k) {
        sum[w][k] += weight * rate[k];
        if (i < 3) stage[w][k] = y[w][k] + next * rate[k];
      }
    }
  }
  for (int w = 0; w < wide; ++w)
    for (int k = 0; k < axes; ++k) y[w][k] = sum[w][k];
}

template <class F, int wide>
CORE_INLINE void any_step(const F& formula, const FormulaJob& job, double dt, const double* of_time,
                          Pack (&y)[wide][F::axes]) {
  constexpr int axes = F::axes;
  Pack rate[most_stages][wide][axes];
  const double* a = job.stage_weights;
  for (int i = 0; i < job.stages; ++i) {
    Pack stage[wide][axes];
    for (int w = 0; w < wide; ++w)
      for (int k = 0; k < axes; ++k) stage[w][k] = y[w][k];
    for (int l = 0; l < i; ++l, ++a) {
      if (*a == 0) continue;
      const double factor = dt * *a;
      for (int w = 0; w < wide; ++w)
        for (int k = 0; k < axes; ++k) stage[w][k] += factor * rate[l][w][k];
    }
    for (int w = 0; w < wide; ++w) formula.velocity(of_time + i * F::time_values, stage[w], rate[i][w]);
  }
  for (int i = 0; i < job.stages; ++i) {
    if (job.weights[i] == 0) continue;
    const double factor = dt * job.weights[i];
    for (int w = 0; w < wide; ++w)
      for (int k = 0; k < axes; ++k) y[w][k] += factor * rate[i][w][k];
  }
}

/// Four stages, each from the one before alone, and all in the sum?
bool is_classical(const FormulaJob& job) {
  const double *a = job.stage_weights, *b = job.weights;
  return job.stages == 4 && a[0] != 0 && a[1] == 0 && a[2] != 0 && a[3] == 0 && a[4] == 0 && a[5] != 0 && b[0] != 0 &&
         b[1] != 0 && b[2] != 0 && b[3] != 0;
}

template <class F>
void carry(const FormulaJob& job) {
  const F formula(job.parameters);
  constexpr int axes = F::axes, wide = F::cheap ? 2 : 1;
  const bool classical = is_classical(job);
  for_groups<axes, wide * lanes>(job, [&](double* const* x, std::size_t first, std::size_t count) {
    Pack y[wide][axes];
    for (int w = 0; w < wide; ++w)
      for (int k = 0; k < axes; ++k) y[w][k] = load(x[k] + static_cast<std::size_t>(w) * lanes);
    const double* of_time = job.of_stages;
    const auto apart = static_cast<std::size_t>(job.stages * F::time_values);
    if (classical)
      for (std::size_t i = 0; i < job.steps; ++i, of_time += apart)
        classical_step<F, wide>(formula, job, job.lengths[i], of_time, y);
    else
      for (std::size_t i = 0; i < job.steps; ++i, of_time += apart)
        any_step<F, wide>(formula, job, job.lengths[i], of_time, y);
    for (int w = 0; w < wide; ++w)
      for (int k = 0; k < axes; ++k) store(x[k] + static_cast<std::size_t>(w) * lanes, y[w][k]);
    if (count == wide * lanes) return;
    for (int k = 0; k < axes; ++k)
      for (std::size_t i = 0; i < count; ++i) job.x[k][first + i] = x[k][i];
  });
}

template <class F>
constexpr FormulaKernels::Entry entry{rates<F>, carry<F>};

}  // namespace

extern const FormulaKernels formula_kernels;
const FormulaKernels formula_kernels = {{
#define FORMULA(name, type) entry<type>,
#include "field/named/formula_list.inc"
#undef FORMULA
}};

}  // namespace gaussdrift::named::CORE_ISA
