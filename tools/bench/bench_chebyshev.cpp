// `chebyshev` on one thread, plan and evaluation, and how many times faster than `direct` it is, measured in the same
// run.
#include <benchmark/benchmark.h>

#include <algorithm>

#include "workloads.hpp"

namespace {

/// Plan and evaluation of Halton points at other Halton points; `direct` is measured at a few of the targets.
template <int d>
void scattered(benchmark::State& state, int count, double sigma, double tolerance, int threads,
               const std::vector<fgtd::Combination<d>>& combinations) {
  const auto work = bench::halton_points<d>(count, sigma);
  constexpr int base[] = {2, 3, 5, 7};
  fgtd::Points<d> targets(d, count);
  for (int j = 0; j < count; ++j)
    for (int l = 0; l < d; ++l) targets(l, j) = bench::halton(j + 21, base[l]);
  int order = 0;
  for (const auto& combination : combinations)
    for (const auto& term : combination) {
      int sum = 0;
      for (const int a : term.derivative) sum += a;
      order = std::max(order, sum);
    }
  const int some = std::min(count, 1024);
  const fgtd::Points<d> few = targets.leftCols(some);
  const fgtd::Plan<d> direct(work.sources, work.weights, sigma,
                             {.derivative_order = order, .method = fgtd::Method::direct, .threads = 1});
  const double direct_seconds = count / static_cast<double>(some) * bench::processor_seconds([&] {
                                  benchmark::DoNotOptimize(direct.evaluate_combinations(few, combinations));
                                });
  fgtd::Choice choice;
  double seconds = 0;
  for (auto _ : state)
    seconds += bench::processor_seconds([&] {
      const fgtd::Plan<d> plan(
          work.sources, work.weights, sigma,
          {.tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::chebyshev, .threads = threads});
      benchmark::DoNotOptimize(plan.evaluate_combinations(targets, combinations));
      choice = plan.choice();
    });
  bench::count_parameters(state, choice);
  state.counters["predicted_ms"] = 1e3 * choice.seconds;
  state.counters["direct/this"] = direct_seconds * static_cast<double>(state.iterations()) / seconds;
}

template <int d>
std::vector<fgtd::Combination<d>> derivative(const fgtd::Derivative<d>& alpha) {
  return {{{alpha, 1.0}}};
}

std::vector<fgtd::Combination<3>> value_and_gradient() {
  return {{{{0, 0, 0}, 1.0}}, {{{1, 0, 0}, 1.0}}, {{{0, 1, 0}, 1.0}}, {{{0, 0, 1}, 1.0}}};
}

constexpr auto in_2d = scattered<2>;
constexpr auto in_3d = scattered<3>;
#define FGTD_BENCHMARK(run, name, ...) \
  BENCHMARK_CAPTURE(run, name, __VA_ARGS__)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()
FGTD_BENCHMARK(in_3d, 1e6_sigma_2_tolerance_1e3, 1000000, 2.0, 1e-3, 1, derivative<3>({}));
FGTD_BENCHMARK(in_3d, 1e6_sigma_2_tolerance_1e7, 1000000, 2.0, 1e-7, 1, derivative<3>({}));
FGTD_BENCHMARK(in_3d, 1e6_sigma_2_tolerance_1e12, 1000000, 2.0, 1e-12, 1, derivative<3>({}));
FGTD_BENCHMARK(in_3d, 1e6_sigma_2_tolerance_1e7_derivative_012, 1000000, 2.0, 1e-7, 1, derivative<3>({0, 1, 2}));
FGTD_BENCHMARK(in_3d, 1e6_sigma_2_tolerance_1e6, 1000000, 2.0, 1e-6, 1, derivative<3>({}));
FGTD_BENCHMARK(in_3d, 1e6_sigma_2_tolerance_1e6_value_and_gradient, 1000000, 2.0, 1e-6, 1, value_and_gradient());
FGTD_BENCHMARK(in_3d, 1e6_sigma_2_tolerance_1e7_two_threads, 1000000, 2.0, 1e-7, 2, derivative<3>({}))->UseRealTime();
FGTD_BENCHMARK(in_3d, 1e4_sigma_2_tolerance_1e7, 10000, 2.0, 1e-7, 1, derivative<3>({}));
FGTD_BENCHMARK(in_2d, 1e5_sigma_1e_4_tolerance_1e8, 100000, 1e-4, 1e-8, 1, derivative<2>({}));
FGTD_BENCHMARK(in_2d, 1e5_sigma_1_tolerance_1e8, 100000, 1.0, 1e-8, 1, derivative<2>({}));
FGTD_BENCHMARK(in_2d, 1e5_sigma_1e2_tolerance_1e8, 100000, 1e2, 1e-8, 1, derivative<2>({}));
FGTD_BENCHMARK(in_2d, 1e5_sigma_1e4_tolerance_1e8, 100000, 1e4, 1e-8, 1, derivative<2>({}));
#undef FGTD_BENCHMARK

}  // namespace
