// The divergence-free field S(y) of Table 6.1 [Sch06]: N = M Halton points in the unit cube, sigma = 2, pair by pair
// and by fgtd at an error of 1e-5 of the largest |S|; preparation and choice are part of every run.
#include <benchmark/benchmark.h>

#include <Eigen/Core>
#include <cstddef>

#include "field/gaussians/divergence_free.hpp"
#include "reproduce/point_sets.hpp"

namespace {

using gaussdrift::GaussianMatrix;
using gaussdrift::GaussianSum;
using Index = Eigen::Index;

constexpr double sigma = 2;

struct Problem {
  fgtd::Points<3> points;
  Eigen::MatrixXd gamma;
};

Problem problem(std::size_t count) {
  Problem result{gaussdrift::reproduce::halton_points<3>(count), Eigen::MatrixXd(static_cast<Index>(count), 3)};
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t l = 0; l < 3; ++l)
      result.gamma(static_cast<Index>(k), static_cast<Index>(l)) =
          gaussdrift::reproduce::halton(k, std::array<int, 3>{7, 11, 13}[l]);
  return result;
}

Eigen::MatrixXd field(const Problem& p, const fgtd::Points<3>& targets, fgtd::Method method, double tolerance) {
  return GaussianSum<3>(p.points, p.gamma, sigma, {.tolerance = tolerance, .method = method, .threads = 1})
      .evaluate(GaussianMatrix::field, targets);
}

void pairs(benchmark::State& state) {
  const Problem p = problem(static_cast<std::size_t>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(field(p, p.points, fgtd::Method::direct, 1e-8));
  state.counters["pairs"] = benchmark::Counter(double(p.points.cols()) * double(p.points.cols()),
                                               benchmark::Counter::kIsIterationInvariantRate);
}

void fast(benchmark::State& state) {
  const Problem p = problem(static_cast<std::size_t>(state.range(0)));
  constexpr double wanted = 1e-5, tolerance = 1e-6;
  const Index sampled = std::min<Index>(200, p.points.cols());
  const fgtd::Points<3> some = p.points.leftCols(sampled);
  const Eigen::MatrixXd exact = field(p, some, fgtd::Method::direct, 1e-8);
  const Eigen::MatrixXd found = field(p, p.points, fgtd::Method::automatic, tolerance).topRows(sampled);
  const double error = (found - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
  if (!(error <= wanted)) return state.SkipWithError("the error is above 1e-5 of the largest |S|");
  for (auto _ : state) benchmark::DoNotOptimize(field(p, p.points, fgtd::Method::automatic, tolerance));
  state.counters["error"] = error;
}

}  // namespace

BENCHMARK(pairs)->Arg(20'000)->Unit(benchmark::kMillisecond);
BENCHMARK(fast)->Arg(20'000)->Arg(1'000'000)->Unit(benchmark::kMillisecond);
