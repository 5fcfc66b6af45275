// The workloads that fgtd is built for, with Method::automatic on one thread: points (sources and targets) a second,
// the method that was taken, and how many times faster than `direct` it is. `direct` is measured in the same run at a
// sample of the targets (about 3e7 pairs) and scaled to all. Every result is compared with `direct` before it is timed.
//
// Counters: points/s; direct/this = time of `direct` over time of this; plan = share of the plan in the time;
// x_value = time over that of the plain sum; growth = time per point over that at a tenth of the points;
// bytes/point = peak memory beyond the arguments, per source and target; speedup = wall time of one thread over two.
#include <benchmark/benchmark.h>

#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <random>
#include <string>

#include "workloads.hpp"

namespace {

template <int d>
using Operators = std::vector<fgtd::Combination<d>>;

template <int d>
Operators<d> value() {
  return {{fgtd::Term<d>{}}};
}

template <int d>
Operators<d> value_and_gradient() {
  Operators<d> operators = value<d>();
  for (std::size_t l = 0; l < d; ++l) {
    fgtd::Term<d> slope;
    slope.derivative[l] = 1;
    operators.push_back({slope});
  }
  return operators;
}

/// Plan and evaluation at the sources themselves or on a grid.
template <int d>
struct Task {
  bench::Workload<d> work;
  fgtd::TensorGrid grid;  // empty: at the sources
  Operators<d> operators = value<d>();
  double tolerance = 1e-6;

  bool on_grid() const { return !grid.axes.empty(); }
  double targets() const {
    return static_cast<double>(on_grid() ? static_cast<Eigen::Index>(grid.size()) : work.sources.cols());
  }
  double points() const { return static_cast<double>(work.sources.cols()) + targets(); }
  int derivative_order() const {
    int order = 0;
    for (const auto& combination : operators)
      for (const auto& term : combination) {
        int sum = 0;
        for (const int a : term.derivative) sum += a;
        order = std::max(order, sum);
      }
    return order;
  }
  fgtd::Options options(int threads) const {
    fgtd::Options options{.tolerance = tolerance, .derivative_order = derivative_order(), .threads = threads};
    if (on_grid()) options.expected_grid = grid;
    return options;
  }
};

struct Run {
  fgtd::Choice choice;
  double plan = 0, total = 0;  // processor seconds
  Eigen::MatrixXd values;
};

template <int d>
Run run(const Task<d>& task, int threads = 1) {
  Run run;
  run.total = bench::processor_seconds([&] {
    const std::clock_t start = std::clock();
    const fgtd::Plan<d> plan(task.work.sources, task.work.weights, task.work.sigma, task.options(threads));
    run.plan = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    run.values = task.on_grid() ? plan.evaluate_combinations(task.grid, task.operators)
                                : plan.evaluate_combinations(task.work.sources, task.operators);
    run.choice = plan.choice();
  });
  return run;
}

/// Seconds of `direct` for all targets, by a sample, and the largest error of `values` there over what is promised.
template <int d>
struct Comparison {
  double seconds = 0, share_of_promise = 0;
};

template <int d>
Comparison<d> compare(const Task<d>& task, const Eigen::MatrixXd& values) {
  const double sources = static_cast<double>(task.work.sources.cols());
  const Eigen::Index all = static_cast<Eigen::Index>(task.targets()),
                     some = std::min(all, std::max<Eigen::Index>(64, static_cast<Eigen::Index>(3e7 / sources)));
  fgtd::Points<d> sample(d, some);
  std::vector<Eigen::Index> place;
  std::minstd_rand random(7);
  for (Eigen::Index i = 0; i < some; ++i) {
    place.push_back(std::uniform_int_distribution<Eigen::Index>(0, all - 1)(random));
    std::size_t rest = static_cast<std::size_t>(place.back());
    for (std::size_t l = 0; l < d; ++l) {
      if (!task.on_grid()) {
        sample(static_cast<Eigen::Index>(l), i) = task.work.sources(static_cast<Eigen::Index>(l), place.back());
        continue;
      }
      const auto& axis = task.grid.axes[l];
      sample(static_cast<Eigen::Index>(l), i) = axis[rest % axis.size()];
      rest /= axis.size();
    }
  }
  const fgtd::Plan<d> direct(
      task.work.sources, task.work.weights, task.work.sigma,
      {.derivative_order = task.derivative_order(), .method = fgtd::Method::direct, .threads = 1});
  Eigen::MatrixXd exact;
  Comparison<d> comparison;
  comparison.seconds = bench::processor_seconds([&] { exact = direct.evaluate_combinations(sample, task.operators); }) *
                       static_cast<double>(all) / static_cast<double>(some);

  // the weight around a target: terms beyond sigma r^2 = L fade
  const double limit = 2 * std::log(1 / task.tolerance) + 40;
  for (Eigen::Index i = 0; i < std::min<Eigen::Index>(some, 64); ++i) {
    double weight = 0;
    for (Eigen::Index j = 0; j < task.work.sources.cols(); ++j) {
      const double squared = task.work.sigma * (task.work.sources.col(j) - sample.col(i)).squaredNorm();
      weight += std::abs(task.work.weights(j, 0)) * std::exp(std::min(0.0, limit - squared));
    }
    for (std::size_t q = 0; q < task.operators.size(); ++q) {
      double scale = 0;
      for (const auto& term : task.operators[q])
        scale += std::abs(term.coefficient) * fgtd::derivative_scale<d>(term.derivative, task.work.sigma);
      const Eigen::Index column = static_cast<Eigen::Index>(q);
      const double error = std::abs(values(place[static_cast<std::size_t>(i)], column) - exact(i, column));
      comparison.share_of_promise =
          std::max(comparison.share_of_promise, error / ((task.tolerance + 6e-14) * scale * weight + 1e-300));
    }
  }
  return comparison;
}

template <int d>
using Make = std::function<Task<d>()>;

/// The task is made when its row is run, and kept for its iterations only.
template <int d>
void row(const std::string& name, const Make<d>& make,
         const std::function<void(benchmark::State&, const Task<d>&, double)>& more = {}) {
  benchmark::RegisterBenchmark(
      name.c_str(),
      [make, more](benchmark::State& state) {
        const Task<d> task = make();
        const Run first = run(task);
        const Comparison<d> direct = compare(task, first.values);
        state.SetLabel(fgtd::to_string(first.choice.method));
        if (!(direct.share_of_promise <= 1)) {
          state.SkipWithError(("error " + std::to_string(direct.share_of_promise) + " times what is promised").c_str());
          return;
        }
        double plan = 0, total = 0;
        for (auto _ : state) {
          const Run again = run(task);
          plan += again.plan;
          total += again.total;
        }
        const double seconds = total / static_cast<double>(state.iterations());
        state.counters["points/s"] = task.points() / seconds;
        state.counters["direct/this"] = direct.seconds / seconds;
        state.counters["plan"] = plan / total;
        state.counters["predicted_ms"] = 1e3 * first.choice.seconds;
        if (more) more(state, task, seconds);
      })
      ->Unit(benchmark::kMillisecond)
      ->MinTime(0.3);
}

/// Compares with the plain sum of the same task.
template <int d>
void against_value(benchmark::State& state, const Task<d>& task, double seconds) {
  Task<d> plain = task;
  plain.operators = value<d>();
  double best = 1e300;
  for (int turn = 0; turn < 3; ++turn) best = std::min(best, run(plain).total);
  state.counters["x_value"] = seconds / best;
}

/// Peak of resident memory, and a new start for it, where the system offers that (Linux).
void restart_peak() { std::ofstream("/proc/self/clear_refs") << "5"; }
double resident(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string word; status >> word;)
    if (word == key) {
      double kilobytes = 0;
      status >> kilobytes;
      return 1024 * kilobytes;
    }
  return 0;
}

/// Compares with a tenth of the points.
template <int d>
std::function<void(benchmark::State&, const Task<d>&, double)> against_tenth(const Make<d>& smaller) {
  return [smaller](benchmark::State& state, const Task<d>& task, double seconds) {
    const Task<d> tenth = smaller();
    double best = 1e300;
    for (int turn = 0; turn < 3; ++turn) best = std::min(best, run(tenth).total);
    state.counters["growth"] = (seconds / task.points()) / (best / tenth.points());
    restart_peak();
    const double before = resident("VmRSS:");
    run(task);
    state.counters["bytes/point"] = (resident("VmHWM:") - before) / task.points();
  };
}

/// Wall time of one thread over that of two. To be run alone on the machine.
template <int d>
void two_threads(benchmark::State& state, const Task<d>& task, double) {
  const auto wall = [&](int threads) {
    double best = 1e300;
    for (int turn = 0; turn < 3; ++turn) {
      const auto start = std::chrono::steady_clock::now();
      benchmark::DoNotOptimize(run(task, threads).values.data());
      best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
    return best;
  };
  const double one = wall(1);
  state.counters["speedup"] = one / wall(2);
}

template <int d>
bench::Workload<d> uniform(int count, double core_radius) {
  std::mt19937_64 random(11);
  std::uniform_real_distribution<double> coordinate(0, 1);
  bench::Workload<d> work{fgtd::Points<d>(d, count), Eigen::MatrixXd(count, 1), 1 / (core_radius * core_radius)};
  for (Eigen::Index i = 0; i < work.sources.size(); ++i) work.sources.data()[i] = coordinate(random);
  for (Eigen::Index j = 0; j < count; ++j) work.weights(j, 0) = coordinate(random);
  return work;
}

template <int d>
fgtd::TensorGrid unit_grid(int nodes) {
  std::vector<double> axis;
  for (int i = 0; i < nodes; ++i) axis.push_back((i + 0.5) / nodes);
  return {std::vector<std::vector<double>>(d, axis)};
}

std::string text(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%g", value);
  return buffer;
}

void register_rows() {
  const auto halton = [](int count, double sigma, double tolerance, Operators<3> operators = value<3>()) {
    return Make<3>([=] { return Task<3>{bench::halton_points<3>(count, sigma), {}, operators, tolerance}; });
  };
  for (const double tolerance : {1e-3, 1e-7, 1e-12})
    row<3>("halton3/1e6/sigma:2/tolerance:" + text(tolerance), halton(1000000, 2, tolerance));
  row<3>("halton3/1e6/sigma:2/tolerance:1e-07/derivative:0,1,2", halton(1000000, 2, 1e-7, {{{{0, 1, 2}, 1.0}}}),
         against_value<3>);
  row<3>("halton3/1e4/sigma:2/tolerance:1e-07", halton(10000, 2, 1e-7));
  for (const int nodes : {200, 700})
    row<2>("cone/4386/grid:" + std::to_string(nodes) + "^2/tolerance:1e-06", [=] {
      return Task<2>{bench::cone(299, 2), bench::square_grid(nodes), value<2>(), 1e-6};
    });
  for (const double tolerance : {1e-4, 1e-8, 1e-12})
    row<2>("uniform2/1e6/eps:4e-3/grid:1000^2/tolerance:" + text(tolerance), [=] {
      return Task<2>{uniform<2>(1000000, 4e-3), unit_grid<2>(1000), value<2>(), tolerance};
    });
  for (const int nodes : {128, 256})
    row<3>("uniform3/1e6/eps:0.02/grid:" + std::to_string(nodes) + "^3/tolerance:1e-06", [=] {
      return Task<3>{uniform<3>(1000000, 0.02), unit_grid<3>(nodes), value<3>(), 1e-6};
    });
  for (const double sigma : {1e-4, 1.0, 1e2, 1e4, 1e6})
    row<2>("halton2/1e5/sigma:" + text(sigma) + "/tolerance:1e-08", [=] {
      return Task<2>{bench::halton_points<2>(100000, sigma), {}, value<2>(), 1e-8};
    });

  row<3>("gradient/halton3/1e6/sigma:2/tolerance:1e-06", halton(1000000, 2, 1e-6, value_and_gradient<3>()),
         against_value<3>);
  row<3>(
      "gradient/uniform3/1e6/eps:0.02/grid:128^3/tolerance:1e-06",
      [] {
        return Task<3>{uniform<3>(1000000, 0.02), unit_grid<3>(128), value_and_gradient<3>(), 1e-6};
      },
      against_value<3>);
  row<2>(
      "gradient/uniform2/1e6/eps:4e-3/grid:1000^2/tolerance:1e-06",
      [] {
        return Task<2>{uniform<2>(1000000, 4e-3), unit_grid<2>(1000), value_and_gradient<2>(), 1e-6};
      },
      against_value<2>);

  row<3>("growth/halton3/1e7/sigma:2/tolerance:1e-07", halton(10000000, 2, 1e-7),
         against_tenth<3>(halton(1000000, 2, 1e-7)));
  // ten times the particles on ten times the nodes, core radius and spacings to match
  row<2>(
      "growth/uniform2/1e7/grid:3162^2/tolerance:1e-06",
      [] {
        return Task<2>{uniform<2>(10000000, 4e-3 / std::sqrt(10.0)), unit_grid<2>(3162), value<2>(), 1e-6};
      },
      against_tenth<2>([] {
        return Task<2>{uniform<2>(1000000, 4e-3), unit_grid<2>(1000), value<2>(), 1e-6};
      }));

  row<3>("threads/halton3/1e6/sigma:2/tolerance:1e-07", halton(1000000, 2, 1e-7), two_threads<3>);
  row<2>(
      "threads/uniform2/1e6/eps:4e-3/grid:1000^2/tolerance:1e-08",
      [] {
        return Task<2>{uniform<2>(1000000, 4e-3), unit_grid<2>(1000), value<2>(), 1e-8};
      },
      two_threads<2>);
  row<3>(
      "threads/uniform3/1e6/eps:0.02/grid:128^3/tolerance:1e-06",
      [] {
        return Task<3>{uniform<3>(1000000, 0.02), unit_grid<3>(128), value<3>(), 1e-6};
      },
      two_threads<3>);
}

}  // namespace

int main(int argc, char** argv) {
  register_rows();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
