// The point sets of the benchmarks: Halton points, and the cone of the thesis's chapter 5 on a lattice.
#pragma once

#include <cmath>
#include <ctime>
#include <vector>

#include "fgtd/fgtd.hpp"

namespace bench {

/// [Sch06, Algorithm 4.1]
inline double halton(int n, int base) {
  double value = 0, digit = 1.0 / base;
  for (; n > 0; n /= base, digit /= base) value += (n % base) * digit;
  return value;
}

template <int d>
struct Workload {
  fgtd::Points<d> sources;
  Eigen::MatrixXd weights;
  double sigma = 1;
};

/// Points in the unit cube, weights in (0, 1).
template <int d>
Workload<d> halton_points(int count, double sigma) {
  constexpr int base[] = {2, 3, 5, 7, 11};
  Workload<d> work{fgtd::Points<d>(d, count), Eigen::MatrixXd(count, 1), sigma};
  for (int j = 0; j < count; ++j) {
    for (int l = 0; l < d; ++l) work.sources(l, j) = halton(j + 1, base[l]);
    work.weights(j, 0) = halton(j + 1, base[d]);
  }
  return work;
}

/// A cone of radius 0.25 on a lattice of `cells` + 1 points an axis in [-1, 1]^2; core radius `overlap` spacings.
inline Workload<2> cone(int cells, double overlap) {
  const double spacing = 2.0 / cells;
  std::vector<double> x, y, weight;
  for (int i = 0; i <= cells; ++i)
    for (int j = 0; j <= cells; ++j) {
      const double px = -1 + i * spacing, py = -1 + j * spacing, r = std::hypot(px - 0.5, py);
      if (r >= 0.25) continue;
      x.push_back(px);
      y.push_back(py);
      weight.push_back(spacing * spacing * (1 - 4 * r));
    }
  const Eigen::Index count = static_cast<Eigen::Index>(x.size());
  Workload<2> work{fgtd::Points<2>(2, count), Eigen::Map<Eigen::VectorXd>(weight.data(), count),
                   1 / std::pow(overlap * spacing, 2)};
  work.sources.row(0) = Eigen::Map<Eigen::RowVectorXd>(x.data(), count);
  work.sources.row(1) = Eigen::Map<Eigen::RowVectorXd>(y.data(), count);
  return work;
}

inline fgtd::TensorGrid square_grid(int nodes) {
  std::vector<double> axis;
  for (int i = 0; i < nodes; ++i) axis.push_back(-1 + 2.0 * i / (nodes - 1));
  return {{axis, axis}};
}

/// Processor seconds that `work` takes, once.
template <class Work>
double processor_seconds(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// The parameters of the chosen method as counters of a benchmark (benchmark::State), by their names.
template <class State>
void count_parameters(State& state, const fgtd::Choice& choice) {
  for (const fgtd::Parameter& parameter : fgtd::parameters(choice)) {
    if (const auto* const length = std::get_if<double>(&parameter.value)) state.counters[parameter.name] = *length;
    if (const auto* const count = std::get_if<std::int64_t>(&parameter.value))
      state.counters[parameter.name] = static_cast<double>(*count);
  }
}

}  // namespace bench
