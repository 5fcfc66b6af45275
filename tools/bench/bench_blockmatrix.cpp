// Products of the matrix of ln|x - y| with a vector: all entries, blocks of low rank, the fast Fourier transform.
#include <benchmark/benchmark.h>

#include <cmath>

#include "blockmatrix/block_matrix.hpp"

namespace gaussdrift::blockmatrix {
namespace {

/// ln|x - y| at equidistant points: products with the same vector.
enum class Product { dense, blocks, shared_blocks, fourier };
void line(benchmark::State& state, Product product) {
  const Eigen::Index count = state.range(0);
  const Eigen::VectorXd points = Eigen::VectorXd::LinSpaced(count, 0, 1), x = Eigen::VectorXd::Random(count);
  Eigen::VectorXd column(count), y;
  for (Eigen::Index k = 0; k < count; ++k) column[k] = k == 0 ? 0 : log_kernel(points[k], 0);
  const auto run = [&](const auto& matrix) {
    for (auto _ : state) {
      y = matrix * x;
      benchmark::DoNotOptimize(y.data());
    }
  };
  if (product == Product::fourier) return run(ToeplitzMatrix(column, column));
  if (product == Product::blocks) return run(BlockMatrix(log_kernel, points, {.degree = 3}));
  if (product == Product::shared_blocks)
    return run(BlockMatrix(log_kernel, points, {.degree = 3, .leaf_size = 16, .bases = Bases::shared}));
  Eigen::MatrixXd dense(count, count);
  for (Eigen::Index j = 0; j < count; ++j)
    for (Eigen::Index i = 0; i < count; ++i) dense(i, j) = column[std::abs(i - j)];
  run(dense);
}

BENCHMARK_CAPTURE(line, dense, Product::dense)->Arg(1 << 13)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(line, blocks, Product::blocks)
    ->Arg(1 << 13)
    ->Arg(1 << 14)
    ->Arg(1 << 15)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(line, shared_blocks, Product::shared_blocks)
    ->Arg(1 << 13)
    ->Arg(1 << 14)
    ->Arg(1 << 15)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(line, fourier, Product::fourier)
    ->Arg(1 << 13)
    ->Arg(1 << 14)
    ->Arg(1 << 15)
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace gaussdrift::blockmatrix
