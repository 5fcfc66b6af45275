// `hermite` on one thread, and how many times faster than `direct` it is, measured in the same run.
#include <benchmark/benchmark.h>

#include "workloads.hpp"

namespace {

/// `run` plans and evaluates and returns the choice; direct_seconds is what `direct` takes for the same.
template <class Run>
void measure(benchmark::State& state, double direct_seconds, const Run& run) {
  fgtd::Choice choice;
  double seconds = 0;
  for (auto _ : state) seconds += bench::processor_seconds([&] { choice = run(); });
  bench::count_parameters(state, choice);
  state.counters["predicted_ms"] = 1e3 * choice.seconds;
  state.counters["direct/this"] = direct_seconds * static_cast<double>(state.iterations()) / seconds;
}

/// Plan and evaluation on an n x n grid.
void grid(benchmark::State& state, const bench::Workload<2>& work, double tolerance, int order) {
  const fgtd::TensorGrid target = bench::square_grid(static_cast<int>(state.range(0)));
  const fgtd::Options options{.tolerance = tolerance,
                              .derivative_order = order,
                              .method = fgtd::Method::hermite,
                              .threads = 1,
                              .expected_grid = target};
  const fgtd::Combination<2> laplacian{{{2, 0}, 1.0}, {{0, 2}, 1.0}}, value{{{0, 0}, 1.0}};
  const auto& combination = order == 0 ? value : laplacian;
  const fgtd::Plan<2> direct(work.sources, work.weights, work.sigma,
                             {.derivative_order = order, .method = fgtd::Method::direct, .threads = 1});
  const double seconds =
      bench::processor_seconds([&] { benchmark::DoNotOptimize(direct.evaluate_combination(target, combination)); });
  measure(state, seconds, [&] {
    const fgtd::Plan<2> plan(work.sources, work.weights, work.sigma, options);
    benchmark::DoNotOptimize(plan.evaluate_combination(target, combination));
    return plan.choice();
  });
}

BENCHMARK_CAPTURE(grid, cone_300_overlap_2, bench::cone(299, 2), 1e-9, 0)
    ->Arg(200)
    ->Arg(700)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid, cone_300_overlap_2_laplacian, bench::cone(299, 2), 1e-9, 2)
    ->Arg(200)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid, cone_600_overlap_20, bench::cone(599, 20), 1e-10, 0)->Arg(700)->Unit(benchmark::kMillisecond);

/// Plan and evaluation of Halton points at themselves; `direct` is measured at a hundredth of the targets.
void scattered(benchmark::State& state, int count, double sigma, double tolerance) {
  const auto work = bench::halton_points<3>(count, sigma);
  const fgtd::Plan<3> direct(work.sources, work.weights, sigma, {.method = fgtd::Method::direct, .threads = 1});
  const fgtd::Points<3> some = work.sources.leftCols(count / 100);
  const double seconds = 100 * bench::processor_seconds([&] { benchmark::DoNotOptimize(direct.evaluate(some)); });
  measure(state, seconds, [&] {
    const fgtd::Plan<3> plan(work.sources, work.weights, sigma,
                             {.tolerance = tolerance, .method = fgtd::Method::hermite, .threads = 1});
    benchmark::DoNotOptimize(plan.evaluate(work.sources));
    return plan.choice();
  });
}

BENCHMARK_CAPTURE(scattered, halton_1e5_sigma_2_tolerance_1e3, 100000, 2.0, 1e-3)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered, halton_1e5_sigma_2_tolerance_1e7, 100000, 2.0, 1e-7)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered, halton_1e5_sigma_2_tolerance_1e12, 100000, 2.0, 1e-12)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered, halton_1e5_sigma_50_tolerance_1e4, 100000, 50.0, 1e-4)->Unit(benchmark::kMillisecond);

}  // namespace
