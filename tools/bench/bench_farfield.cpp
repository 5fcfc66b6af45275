// farfield against all pairs, one thread. Rows of one number of points are to be compared with each other: `direct` is
// the baseline. Every fast row gives its measured error: of the field, relative to the field (force_error) and to what
// the promise is relative to (promise_error), over 300 of the targets.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>

#include "farfield/farfield.hpp"

namespace {

using farfield::Kernel;
using farfield::Method;

template <int d>
farfield::Points<d> cube(Eigen::Index count) {
  std::mt19937 random(1);
  farfield::Points<d> points(d, count);
  for (double& x : points.reshaped()) x = static_cast<double>(random()) * 0x1p-32;
  return points;
}

/// Plummer's sphere of scale 1, cut at 20.
farfield::Points<3> plummer(Eigen::Index count) {
  std::mt19937 random(2);
  const auto in = [&](double low, double high) {
    return low + (high - low) * (static_cast<double>(random()) * 0x1p-32);
  };
  farfield::Points<3> points(3, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    double radius;
    do radius = 1 / std::sqrt(std::pow(in(1e-9, 1), -2.0 / 3) - 1);
    while (!(radius < 20));
    const double height = in(-1, 1), angle = in(0, 6.283185307179586), flat = std::sqrt(1 - height * height);
    points.col(j) << radius * flat * std::cos(angle), radius * flat * std::sin(angle), radius * height;
  }
  return points;
}

template <int d>
void report_error(benchmark::State& state, Kernel kernel, const farfield::Points<d>& points,
                  const farfield::Points<d>& field) {
  const Eigen::Index some = std::min<Eigen::Index>(300, points.cols()), step = points.cols() / some;
  farfield::Points<d> targets(d, some), found(d, some);
  for (Eigen::Index i = 0; i < some; ++i) {
    targets.col(i) = points.col(i * step);
    found.col(i) = field.col(i * step);
  }
  const farfield::Plan<d> plan(kernel, points, targets, {.method = Method::direct, .threads = 1, .potential = false});
  const farfield::Points<d> exact = plan.evaluate(Eigen::VectorXd::Ones(points.cols())).field;
  double scale = 0;
  for (Eigen::Index i = 0; i < some; ++i) {
    double sum = 0;
    for (Eigen::Index j = 0; j < points.cols(); ++j) {
      const double squared = (points.col(j) - targets.col(i)).squaredNorm();
      if (squared > 0) sum += d == 3 ? 1 / squared : 1 / std::sqrt(squared);
    }
    scale += sum * sum;
  }
  const double error = (found - exact).norm();
  state.counters["force_error"] = error / exact.norm();
  state.counters["promise_error"] = error / std::sqrt(scale);
}

/// A plan and one evaluation; charges 1.
template <int d>
void sum(benchmark::State& state, Kernel kernel, const farfield::Points<d>& points, const farfield::Options& options) {
  const Eigen::VectorXd charges = Eigen::VectorXd::Ones(points.cols());
  farfield::Points<d> field;
  for (auto _ : state) {
    const farfield::Plan<d> plan(kernel, points, options);
    field = plan.evaluate(charges).field;
    benchmark::DoNotOptimize(field.data());
  }
  if (options.method == Method::direct) {
    const double pairs = static_cast<double>(state.iterations()) * static_cast<double>(points.cols() * points.cols());
    state.counters["pairs/s"] = benchmark::Counter(pairs, benchmark::Counter::kIsRate);
  } else if (kernel != Kernel::vortex_blob) {
    report_error<d>(state, kernel, points, field);
  }
}

void in_space(benchmark::State& state, Method method, double tolerance, int threads, bool sphere, bool potential) {
  const Eigen::Index count = state.range(0);
  sum<3>(state, Kernel::coulomb, sphere ? plummer(count) : cube<3>(count),
         {.tolerance = tolerance, .method = method, .threads = threads, .potential = potential});
}

void in_plane(benchmark::State& state, Kernel kernel, Method method, double tolerance, bool potential) {
  sum<2>(state, kernel, cube<2>(state.range(0)),
         {.tolerance = tolerance,
          .method = method,
          .threads = 1,
          .core_radius = kernel == Kernel::vortex_blob ? 0.004 : 0,
          .potential = potential});
}

void large(benchmark::internal::Benchmark* row) {
  row->Unit(benchmark::kMillisecond)->Iterations(1)->MeasureProcessCPUTime();
}
void space_sizes(benchmark::internal::Benchmark* row) {
  for (const int count : {5000, 25000, 100000, 400000, 1600000}) row->Arg(count);
  large(row);
}
void small_sizes(benchmark::internal::Benchmark* row) {
  for (const int count : {5000, 25000, 100000}) row->Arg(count);
  large(row);
}
void break_even(benchmark::internal::Benchmark* row) {
  for (const int count : {500, 1000, 2000, 5000, 10000}) row->Arg(count);
  row->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
}

// Tolerances at which the field's relative error in the cube is below 5e-6 and 1e-9.
constexpr double for_5e_6 = 3e-4, for_1e_9 = 4e-7;

// Where `auto` leaves all pairs behind.
BENCHMARK_CAPTURE(in_space, few_direct, Method::direct, 1e-6, 1, false, true)->Apply(break_even);
BENCHMARK_CAPTURE(in_space, few_auto_5e_6, Method::automatic, for_5e_6, 1, false, true)->Apply(break_even);
BENCHMARK_CAPTURE(in_space, few_auto_1e_9, Method::automatic, for_1e_9, 1, false, true)->Apply(break_even);

BENCHMARK_CAPTURE(in_space, direct, Method::direct, 1e-6, 1, false, true)->Apply(small_sizes);
BENCHMARK_CAPTURE(in_space, direct_field_alone, Method::direct, 1e-6, 1, false, false)->Arg(25000)->Apply(large);
BENCHMARK_CAPTURE(in_space, symmetric_5e_6, Method::symmetric, for_5e_6, 1, false, true)->Apply(space_sizes);
BENCHMARK_CAPTURE(in_space, symmetric_1e_9, Method::symmetric, for_1e_9, 1, false, true)->Apply(space_sizes);
BENCHMARK_CAPTURE(in_space, tree_5e_6, Method::tree, for_5e_6, 1, false, true)->Apply(small_sizes);
BENCHMARK_CAPTURE(in_space, plummer_5e_6, Method::symmetric, for_5e_6, 1, true, true)->Apply(space_sizes);
BENCHMARK_CAPTURE(in_space, two_threads_5e_6, Method::symmetric, for_5e_6, 2, false, true)->Arg(400000)->Apply(large);

BENCHMARK_CAPTURE(in_plane, log_direct, Kernel::log, Method::direct, 1e-6, true)->Arg(25000)->Apply(large);
BENCHMARK_CAPTURE(in_plane, log_symmetric, Kernel::log, Method::symmetric, 1e-6, true)->Apply(space_sizes);
BENCHMARK_CAPTURE(in_plane, vortex_direct, Kernel::vortex_blob, Method::direct, 1e-6, false)->Arg(25000)->Apply(large);
BENCHMARK_CAPTURE(in_plane, vortex_symmetric, Kernel::vortex_blob, Method::symmetric, 1e-6, false)->Apply(small_sizes);

}  // namespace
