// Fits to Franke's function and evaluations of them, one thread: the processor time, and the errors at 10^4 other random
// points. tools/bench/scipy_interpolation.py does the same with SciPy.
#include <benchmark/benchmark.h>

#include <cmath>
#include <ctime>
#include <random>
#include <string>

#include "rbf/interpolant.hpp"

namespace {

rbf::Points<2> square(Eigen::Index count, unsigned seed) {
  std::mt19937 random(seed);
  rbf::Points<2> points(2, count);
  for (double& x : points.reshaped()) x = static_cast<double>(random()) * 0x1p-32;
  return points;
}

Eigen::VectorXd franke(const rbf::Points<2>& points) {
  Eigen::VectorXd values(points.cols());
  for (Eigen::Index i = 0; i < points.cols(); ++i) {
    const double x = 9 * points(0, i), y = 9 * points(1, i);
    values[i] = 0.75 * std::exp(-((x - 2) * (x - 2) + (y - 2) * (y - 2)) / 4) +
                0.75 * std::exp(-(x + 1) * (x + 1) / 49 - (y + 1) / 10) +
                0.5 * std::exp(-((x - 7) * (x - 7) + (y - 3) * (y - 3)) / 4) -
                0.2 * std::exp(-(x - 4) * (x - 4) - (y - 7) * (y - 7));
  }
  return values;
}

double processor_seconds() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

void fit(benchmark::State& state, rbf::Kernel kernel) {
  const rbf::Points<2> points = square(state.range(0), 1), targets = square(10000, 2);
  const Eigen::VectorXd values = franke(points), exact = franke(targets);
  for (auto _ : state) {
    const double begun = processor_seconds();
    const rbf::Interpolant<2> interpolant({kernel}, points, values, {.threads = 1});
    const double fitted = processor_seconds();
    const Eigen::VectorXd errors = interpolant.evaluate(targets).col(0) - exact;
    state.SetIterationTime(fitted - begun);
    state.counters["evaluate_s"] = processor_seconds() - fitted;
    state.counters["rms_error"] = errors.norm() / std::sqrt(static_cast<double>(errors.size()));
    state.counters["max_error"] = errors.cwiseAbs().maxCoeff();
    state.counters["left_out"] = interpolant.report().left_out[0];
    state.counters["residual"] = interpolant.report().residual;
    state.counters["iterations"] = interpolant.report().iterations;
    state.counters["shape"] = interpolant.report().function.shape;
  }
}

}  // namespace

int main(int argc, char** argv) {
  for (const rbf::Kernel kernel : rbf::kernels())
    benchmark::RegisterBenchmark(rbf::to_string(kernel).c_str(), [=](benchmark::State& state) { fit(state, kernel); })
        ->Arg(1000)
        ->Arg(4000)
        ->Arg(10000)
        ->Arg(100000)
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime()
        ->Iterations(1);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
}
