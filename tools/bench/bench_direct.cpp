// Pairs a second of `direct` on one thread: direct<dimension, order of the derivative>.
#include <benchmark/benchmark.h>

#include "workloads.hpp"

namespace {

template <int d, int order>
void direct(benchmark::State& state) {
  const auto work = bench::halton_points<d>(10000, 20.0);
  const fgtd::Plan<d> plan(work.sources, work.weights, work.sigma,
                           {.derivative_order = order, .method = fgtd::Method::direct, .threads = 1});
  fgtd::Derivative<d> alpha{};
  alpha[0] = order;
  for (auto _ : state) benchmark::DoNotOptimize(plan.evaluate(work.sources, alpha));
  state.counters["pairs"] = benchmark::Counter(1e8, benchmark::Counter::kIsIterationInvariantRate);
}

BENCHMARK_TEMPLATE(direct, 1, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(direct, 2, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(direct, 3, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(direct, 4, 0)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(direct, 2, 2)->Unit(benchmark::kMillisecond);
BENCHMARK_TEMPLATE(direct, 3, 2)->Unit(benchmark::kMillisecond);

}  // namespace
