// What an addend costs: ExactSum against a plain loop, over the same numbers of both signs and many sizes.
#include <benchmark/benchmark.h>

#include <cmath>
#include <random>
#include <vector>

#include "base/exact_sum.hpp"

namespace {

std::vector<double> numbers() {
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> all(100000);
  for (double& x : all) x = normal(random) * std::exp2(std::floor(20 * normal(random)));
  return all;
}

void exact(benchmark::State& state) {
  const std::vector<double> all = numbers();
  for (auto _ : state) {
    gaussdrift::base::ExactSum sum;
    sum.add(std::span(all));
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}

void plain(benchmark::State& state) {
  const std::vector<double> all = numbers();
  for (auto _ : state) {
    double sum = 0;
    for (const double x : all) sum += x;
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<std::int64_t>(all.size()));
}

void value(benchmark::State& state) {
  const std::vector<double> all = numbers();
  gaussdrift::base::ExactSum sum;
  sum.add(std::span(all));
  for (auto _ : state) benchmark::DoNotOptimize(sum.value());
}

BENCHMARK(exact);
BENCHMARK(plain);
BENCHMARK(value);

}  // namespace
