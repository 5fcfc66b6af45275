// General kernels of farfield against all pairs, one thread, processor time. Every row sums both ways in turn: all pairs at
// some of the targets only, so that `times_direct` compares what ran at the same time on this machine.
//
// Time         of one evaluation;  times_direct  all pairs beside it;  with_plan  all pairs beside plan and evaluation
// plan_s       seconds of the plan, which measures its own error by one evaluation
// storage_MB   bases and couplings;  rank  of the lowest level
// measured     the error that the tolerance bounds, as the plan has measured it
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <random>
#include <string>

#include "farfield/general.hpp"

namespace {

using farfield::GeneralMethod;
using farfield::GeneralOptions;
using farfield::KernelFunction;

template <int d>
farfield::Points<d> cube(Eigen::Index count) {
  std::mt19937 random(1);
  farfield::Points<d> points(d, count);
  for (double& x : points.reshaped()) x = static_cast<double>(random()) * 0x1p-32;
  return points;
}

double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <int d>
void sum(benchmark::State& state, const KernelFunction& kernel, GeneralOptions options) {
  const Eigen::Index count = state.range(0), some = std::min<Eigen::Index>(count, 2048);
  const farfield::Points<d> points = cube<d>(count);
  const Eigen::VectorXd charges = Eigen::VectorXd::Ones(count);
  options.method = GeneralMethod::interpolation;
  options.threads = 1;
  double fast = HUGE_VAL, direct = HUGE_VAL, plan_seconds = HUGE_VAL;
  farfield::GeneralChoice choice;
  for (auto _ : state) {
    const double begun = processor_seconds();
    const farfield::GeneralPlan<d> plan(kernel, points, options);
    const double planned = processor_seconds();
    benchmark::DoNotOptimize(plan.evaluate(charges));
    const double done = processor_seconds();
    state.SetIterationTime(done - planned);
    fast = std::min(fast, done - planned);
    plan_seconds = std::min(plan_seconds, planned - begun);
    choice = plan.choice();
    const farfield::GeneralPlan<d> all_pairs(kernel, points, farfield::Points<d>(points.leftCols(some)),
                                             {.method = GeneralMethod::direct, .threads = 1});
    const double before = processor_seconds();
    benchmark::DoNotOptimize(all_pairs.evaluate(charges));
    direct = std::min(direct, (processor_seconds() - before) * static_cast<double>(count) / static_cast<double>(some));
  }
  state.counters["times_direct"] = direct / fast;
  state.counters["with_plan"] = direct / (fast + plan_seconds);
  state.counters["direct_s"] = direct;
  state.counters["plan_s"] = plan_seconds;
  state.counters["storage_MB"] = (choice.basis_bytes + choice.coupling_bytes) / 1e6;
  state.counters["rank"] = choice.levels.empty() ? 0 : static_cast<double>(choice.levels.back().rank);
  state.counters["measured"] = choice.measured;
}

template <int d>
void add(const std::string& name, const KernelFunction& kernel, Eigen::Index count, const GeneralOptions& options,
         int iterations = 3) {
  benchmark::RegisterBenchmark((std::to_string(d) + "D/" + name).c_str(),
                               [=](benchmark::State& state) { sum<d>(state, kernel, options); })
      ->Arg(count)
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime()
      ->Iterations(iterations);
}

}  // namespace

int main(int argc, char** argv) {
  const KernelFunction yukawa = KernelFunction::yukawa(1);
  const auto each = [](const std::string& digits, double tolerance, const KernelFunction& kernel,
                       const std::string& name) {
    add<3>(name + digits, kernel, 100000, {.tolerance = tolerance});
    add<2>(name + digits, kernel, 100000, {.tolerance = tolerance});
  };
  each("/1e-6", 1e-6, yukawa, "yukawa");
  each("/1e-6", 1e-6, KernelFunction::inverse_power(4), "inverse-power-4");
  each("/1e-6", 1e-6, KernelFunction::gaussian(10), "gaussian");
  each("/1e-3", 1e-3, yukawa, "yukawa");
  add<3>("yukawa/1e-6", yukawa, 1000000, {.tolerance = 1e-6}, 1);
  // Storage at equal error: what is not recompressed, and what is, to the error that the former has.
  add<3>("yukawa/not recompressed", yukawa, 20000, {.tolerance = 1e-6, .recompress = false}, 1);
  add<3>("yukawa/to the same error", yukawa, 20000, {.tolerance = 2e-7}, 1);
  // One order for all levels.
  add<3>("yukawa/1e-4/orders by level", yukawa, 100000, {.tolerance = 1e-4, .recompress = false}, 1);
  add<3>("yukawa/1e-4/one order", yukawa, 100000, {.tolerance = 1e-4, .recompress = false, .variable_order = false}, 1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
