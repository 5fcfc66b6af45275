// `cells` and `outer_product` on one thread, Plan included, and how many times faster than `direct` they are, measured in the
// same run at a part of the targets.
#include <benchmark/benchmark.h>

#include "workloads.hpp"

namespace {

/// `run` plans and evaluates and returns the choice; direct_seconds is what `direct` takes for the same.
template <class Run>
void measure(benchmark::State& state, double direct_seconds, const Run& run) {
  fgtd::Choice choice;
  double seconds = 0;
  for (auto _ : state) seconds += bench::processor_seconds([&] { choice = run(); });
  state.SetLabel(fgtd::to_string(choice.method));
  bench::count_parameters(state, choice);
  state.counters["predicted_ms"] = 1e3 * choice.seconds;
  state.counters["direct/this"] = direct_seconds * static_cast<double>(state.iterations()) / seconds;
}

/// Seconds of `direct` for `count` targets, from the first thousand.
template <int d>
double direct_seconds(const bench::Workload<d>& work, const fgtd::Points<d>& targets) {
  const fgtd::Plan<d> direct(work.sources, work.weights, work.sigma, {.method = fgtd::Method::direct, .threads = 1});
  const Eigen::Index some = std::min<Eigen::Index>(1000, targets.cols());
  const fgtd::Points<d> few = targets.leftCols(some);
  return static_cast<double>(targets.cols()) / static_cast<double>(some) *
         bench::processor_seconds([&] { benchmark::DoNotOptimize(direct.evaluate(few)); });
}

/// Halton points, N = M, targets shifted by 19 places in the sequence.
template <int d>
void halton(benchmark::State& state, int count, double sigma, double tolerance, int order, fgtd::Method method) {
  auto work = bench::halton_points<d>(count + 19, sigma);
  const fgtd::Points<d> targets = work.sources.rightCols(count);
  work.sources = work.sources.leftCols(count).eval();
  work.weights = work.weights.topRows(count).eval();
  fgtd::Derivative<d> alpha{};
  alpha[0] = order;
  measure(state, direct_seconds<d>(work, targets), [&] {
    const fgtd::Plan<d> plan(work.sources, work.weights, sigma,
                             {.tolerance = tolerance, .derivative_order = order, .method = method, .threads = 1});
    benchmark::DoNotOptimize(plan.evaluate(targets, alpha));
    return plan.choice();
  });
}

void halton_plane(benchmark::State& state) {
  halton<2>(state, 100000, static_cast<double>(state.range(0)), 1e-8, 0, fgtd::Method::cells);
}
BENCHMARK(halton_plane)->Arg(10000)->Arg(1000000)->Arg(100000000)->Unit(benchmark::kMillisecond);

void halton_plane_automatic(benchmark::State& state) {
  halton<2>(state, 100000, static_cast<double>(state.range(0)), 1e-8, 0, fgtd::Method::automatic);
}
BENCHMARK(halton_plane_automatic)->Arg(10000)->Arg(1000000)->Unit(benchmark::kMillisecond);

void halton_plane_second_derivative(benchmark::State& state) {
  halton<2>(state, 100000, static_cast<double>(state.range(0)), 1e-8, 2, fgtd::Method::cells);
}
BENCHMARK(halton_plane_second_derivative)->Arg(10000)->Arg(1000000)->Unit(benchmark::kMillisecond);

void halton_line(benchmark::State& state) {
  halton<1>(state, 100000, static_cast<double>(state.range(0)), 1e-8, 0, fgtd::Method::cells);
}
BENCHMARK(halton_line)->Arg(1000000000)->Unit(benchmark::kMillisecond);

void halton_cube(benchmark::State& state) {
  halton<3>(state, 100000, static_cast<double>(state.range(0)), 1e-8, 0, fgtd::Method::cells);
}
BENCHMARK(halton_cube)->Arg(2000)->Arg(20000)->Unit(benchmark::kMillisecond);

void halton_four(benchmark::State& state) {
  halton<4>(state, 100000, static_cast<double>(state.range(0)), 1e-8, 0, fgtd::Method::cells);
}
BENCHMARK(halton_four)->Arg(1000)->Unit(benchmark::kMillisecond);

/// The cone on an n x n grid.
void cone(benchmark::State& state, fgtd::Method method, double tolerance, int order) {
  const auto work = bench::cone(299, 2);
  const fgtd::TensorGrid target = bench::square_grid(static_cast<int>(state.range(0)));
  fgtd::Points<2> nodes(2, static_cast<Eigen::Index>(target.size()));
  for (Eigen::Index i = 0; i < nodes.cols(); ++i) {
    nodes(0, i) = target.axes[0][static_cast<std::size_t>(i) % target.axes[0].size()];
    nodes(1, i) = target.axes[1][static_cast<std::size_t>(i) / target.axes[0].size()];
  }
  const fgtd::Combination<2> laplacian{{{2, 0}, 1.0}, {{0, 2}, 1.0}}, value{{{0, 0}, 1.0}};
  measure(state, direct_seconds<2>(work, nodes), [&] {
    const fgtd::Plan<2> plan(
        work.sources, work.weights, work.sigma,
        {.tolerance = tolerance, .derivative_order = order, .method = method, .threads = 1, .expected_grid = target});
    benchmark::DoNotOptimize(plan.evaluate_combination(target, order == 0 ? value : laplacian));
    return plan.choice();
  });
}
BENCHMARK_CAPTURE(cone, outer, fgtd::Method::outer_product, 1e-6, 0)->Arg(200)->Arg(700)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cone, outer_1e12, fgtd::Method::outer_product, 1e-12, 0)
    ->Arg(200)
    ->Arg(700)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cone, outer_laplacian, fgtd::Method::outer_product, 1e-6, 2)
    ->Arg(200)
    ->Arg(700)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(cone, automatic, fgtd::Method::automatic, 1e-6, 0)->Arg(200)->Arg(700)->Unit(benchmark::kMillisecond);

/// Particles in the cube on a grid of 64^3 nodes, a core radius of twice their mean distance.
void cube_on_grid(benchmark::State& state) {
  const int count = static_cast<int>(state.range(0));
  const auto work = bench::halton_points<3>(count, 0.25 * std::pow(count, 2.0 / 3));
  std::vector<double> axis;
  for (int i = 0; i < 64; ++i) axis.push_back(i / 63.0);
  const fgtd::TensorGrid target{{axis, axis, axis}};
  measure(state, direct_seconds<3>(work, work.sources) * static_cast<double>(target.size()) / count, [&] {
    const fgtd::Plan<3> plan(
        work.sources, work.weights, work.sigma,
        {.tolerance = 1e-6, .method = fgtd::Method::outer_product, .threads = 1, .expected_grid = target});
    benchmark::DoNotOptimize(plan.evaluate(target));
    return plan.choice();
  });
}
BENCHMARK(cube_on_grid)->Arg(1000)->Arg(10000)->Arg(100000)->Unit(benchmark::kMillisecond);

}  // namespace
