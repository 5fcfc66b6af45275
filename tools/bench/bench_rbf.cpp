// rbf against all pairs, one thread: the processor time of a plan and one evaluation, N = M. Every row sums both ways in
// turn: `direct` at some of the targets only, so that `times_direct` compares what ran at the same time on this machine.
// promise_error is the largest error at these targets, relative to max |phi| times the weights: what is promised.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <ctime>
#include <random>
#include <string>

#include "rbf/rbf.hpp"

namespace {

template <int d>
rbf::Points<d> cube(Eigen::Index count, unsigned seed) {
  std::mt19937 random(seed);
  rbf::Points<d> points(d, count);
  for (double& x : points.reshaped()) x = static_cast<double>(random()) * 0x1p-32;
  return points;
}

double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <int d>
void sum(benchmark::State& state, rbf::Function function, double tolerance, int derivative_order) {
  const Eigen::Index count = state.range(0), some = std::min<Eigen::Index>(count, 2048);
  const rbf::Points<d> centres = cube<d>(count, 1), targets = cube<d>(count, 2);
  const Eigen::MatrixXd weights = cube<1>(count, 3).transpose().array() * 2 - 1;
  rbf::Options options{.tolerance = tolerance,
                       .derivative_order = derivative_order,
                       .threads = 1,
                       .range = rbf::range_of<d>(centres, targets)};
  std::vector<rbf::Combination<d>> wanted{{{{}, 1.0}}};
  for (std::size_t l = 0; l < d && derivative_order > 0; ++l) {
    rbf::Derivative<d> along{};
    along[l] = 1;
    wanted.push_back({{along, 1.0}});
  }
  double fast = HUGE_VAL, direct = HUGE_VAL;
  Eigen::MatrixXd values, exact;
  rbf::Choice choice;
  for (auto _ : state) {
    const double begun = processor_seconds();
    const rbf::Plan<d> plan(function, centres, weights, options);
    values = plan.evaluate_combinations(targets, wanted);
    const double middle = processor_seconds();
    state.SetIterationTime(middle - begun);
    fast = std::min(fast, middle - begun);
    choice = plan.choice();
    rbf::Options all_pairs = options;
    all_pairs.method = rbf::Method::direct;
    exact = rbf::Plan<d>(function, centres, weights, all_pairs).evaluate_combinations(targets.leftCols(some), wanted);
    direct = std::min(direct, (processor_seconds() - middle) * static_cast<double>(count) / static_cast<double>(some));
  }
  state.counters["times_direct"] = direct / fast;
  state.counters["direct_s"] = direct;
  state.counters["gaussians"] = static_cast<double>(choice.terms.size());
  state.counters["promise_error"] =
      (values.col(0).head(some) - exact.col(0)).cwiseAbs().maxCoeff() / choice.largest / weights.cwiseAbs().sum();
}

template <int d>
void add(const rbf::Function& function, Eigen::Index count, double tolerance, int derivative_order) {
  const std::string name =
      std::to_string(d) + "D/" + rbf::to_string(function.kernel) +
      (rbf::takes_shape(function.kernel) ? "/shape " + std::to_string(function.shape).substr(0, 4) : "") +
      (tolerance < 1e-6 ? "/1e-9" : "/1e-6") + (derivative_order > 0 ? "/with gradient" : "");
  benchmark::RegisterBenchmark(name.c_str(),
                               [=](benchmark::State& state) { sum<d>(state, function, tolerance, derivative_order); })
      ->Arg(count)
      ->Unit(benchmark::kMillisecond)
      ->UseManualTime()
      ->Iterations(4);
}

template <int d>
void add_all() {
  for (const rbf::Kernel kernel : rbf::kernels()) {
    const rbf::Function function{kernel, rbf::takes_shape(kernel) ? 0.3 : 0};
    add<d>(function, 100000, 1e-6, 0);
    if (rbf::takes_shape(kernel)) add<d>({kernel, 0.1}, 100000, 1e-6, 0);
    add<d>(function, 100000, 1e-9, 0);
    add<d>(function, 100000, 1e-6, 1);
  }
  add<d>({rbf::Kernel::multiquadric, 0.3}, 1000000, 1e-6, 0);
}

}  // namespace

int main(int argc, char** argv) {
  add_all<1>();
  add_all<2>();
  add_all<3>();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
