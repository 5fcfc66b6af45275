// `spread` on one thread, and how many times faster than `direct` it is, measured in the same run on a part of the
// targets. Times contain the plan.
#include <benchmark/benchmark.h>

#include <cmath>
#include <string>

#include "workloads.hpp"

namespace {

/// Reproducible points in [low, high]^d, in no order (additive recurrence with irrational steps), and weights in (0,
/// 1).
template <int d>
bench::Workload<d> cloud(int count, double low, double high, double sigma) {
  const double step[] = {0.8191725133961645, 0.6710436067037893, 0.5497004779019703, 0.4503};
  bench::Workload<d> work{fgtd::Points<d>(d, count), Eigen::MatrixXd(count, 1), sigma};
  for (int j = 0; j < count; ++j) {
    const double number = static_cast<double>((static_cast<long long>(j) * 7919) % count);
    for (int l = 0; l < d; ++l) work.sources(l, j) = low + (high - low) * std::fmod(0.5 + number * step[l], 1.0);
    work.weights(j, 0) = std::fmod(0.25 + number * step[3], 1.0);
  }
  return work;
}

template <int d>
fgtd::TensorGrid cube(int nodes, double low, double high) {
  std::vector<double> axis;
  for (int i = 0; i < nodes; ++i) axis.push_back(low + (high - low) * i / (nodes - 1));
  return {std::vector<std::vector<double>>(d, axis)};
}

template <int d>
std::vector<fgtd::Combination<d>> combinations(int order) {
  std::vector<fgtd::Combination<d>> list{{fgtd::Term<d>{}}};
  for (std::size_t l = 0; order > 0 && l < d; ++l) {
    fgtd::Term<d> first;
    first.derivative[l] = 1;
    list.push_back({first});
  }
  return list;
}

template <int d>
double direct_seconds(const bench::Workload<d>& work, int order, double targets) {
  constexpr int some = 64;
  const fgtd::Plan<d> direct(work.sources, work.weights, work.sigma,
                             {.derivative_order = order, .method = fgtd::Method::direct, .threads = 1});
  const fgtd::Points<d> part = work.sources.leftCols(some);
  return targets / some * bench::processor_seconds([&] {
           benchmark::DoNotOptimize(direct.evaluate_combinations(part, combinations<d>(order)));
         });
}

void report(benchmark::State& state, const fgtd::Choice& choice, double direct, double seconds) {
  state.SetLabel(fgtd::to_string(choice.method));
  bench::count_parameters(state, choice);
  state.counters["predicted_ms"] = 1e3 * choice.seconds;
  state.counters["direct/this"] = direct * static_cast<double>(state.iterations()) / seconds;
}

/// Plan and evaluation on a grid over the cloud; order 1: value and gradient in one call.
template <int d>
void grid(benchmark::State& state, double low, double width, double tolerance, int order) {
  const auto work = cloud<d>(1000000, low, 1, 1 / (width * width));
  const fgtd::TensorGrid target = cube<d>(static_cast<int>(state.range(0)), low, 1);
  fgtd::Options options{
      .tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::spread, .threads = 1};
  options.expected_grid = target;
  const double direct = direct_seconds<d>(work, order, static_cast<double>(target.size()));
  fgtd::Choice choice;
  double seconds = 0;
  for (auto _ : state)
    seconds += bench::processor_seconds([&] {
      const fgtd::Plan<d> plan(work.sources, work.weights, work.sigma, options);
      benchmark::DoNotOptimize(plan.evaluate_combinations(target, combinations<d>(order)));
      choice = plan.choice();
    });
  report(state, choice, direct, seconds);
}

constexpr auto grid_2d = grid<2>;
constexpr auto grid_3d = grid<3>;
BENCHMARK_CAPTURE(grid_2d, square_width_4e3_tolerance_1e4, 0, 4e-3, 1e-4, 0)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid_2d, square_width_4e3_tolerance_1e8, 0, 4e-3, 1e-8, 0)->Arg(1000)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid_2d, square_width_4e3_tolerance_1e12, 0, 4e-3, 1e-12, 0)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid_2d, double_square_width_4e3_tolerance_1e8, -1, 4e-3, 1e-8, 0)
    ->Arg(1000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid_3d, cube_width_2e2_tolerance_1e6, 0, 2e-2, 1e-6, 0)
    ->Arg(128)
    ->Arg(256)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(grid_3d, cube_width_2e2_tolerance_1e6_gradient, 0, 2e-2, 1e-6, 1)
    ->Arg(128)
    ->Arg(256)
    ->Unit(benchmark::kMillisecond);

/// Plan and evaluation of points at themselves.
template <int d>
void scattered(benchmark::State& state, double sigma, double tolerance, int order) {
  const auto work = bench::halton_points<d>(static_cast<int>(state.range(0)), sigma);
  const fgtd::Options options{
      .tolerance = tolerance, .derivative_order = order, .method = fgtd::Method::spread, .threads = 1};
  const double direct = direct_seconds<d>(work, order, static_cast<double>(state.range(0)));
  fgtd::Choice choice;
  double seconds = 0;
  for (auto _ : state)
    seconds += bench::processor_seconds([&] {
      const fgtd::Plan<d> plan(work.sources, work.weights, sigma, options);
      benchmark::DoNotOptimize(plan.evaluate_combinations(work.sources, combinations<d>(order)));
      choice = plan.choice();
    });
  report(state, choice, direct, seconds);
}

constexpr auto scattered_2d = scattered<2>;
constexpr auto scattered_3d = scattered<3>;
BENCHMARK_CAPTURE(scattered_2d, halton_sigma_1e4_tolerance_1e8, 1e4, 1e-8, 0)
    ->Arg(1000)
    ->Arg(100000)
    ->Arg(1000000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered_2d, halton_sigma_1e4_tolerance_1e8_gradient, 1e4, 1e-8, 1)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(scattered_3d, halton_sigma_200_tolerance_1e6, 200, 1e-6, 0)
    ->Arg(100000)
    ->Unit(benchmark::kMillisecond);

}  // namespace
