// Table 4.9 of [Sch06]: seconds and error of `hermite` over the compiler's optimisation level. Built once for every
// level with the portable inner loops (CMakeLists.txt, target bench_levels); prints one row.
//   10 000 Halton points at themselves, d = 3, sigma = 2, alpha = (0,1,2), p = 9, every one of 3^3 boxes, one thread
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <vector>

#include "core/buffer.hpp"
#include "fgtd/hermite/hermite.hpp"
#include "workloads.hpp"

namespace {

constexpr int count = 10000;
constexpr double sigma = 2;

/// D^(0,1,2) exp(-sigma r^2), with H_1(t) = 2t and H_2(t) = 4t^2 - 2.
double derivative(const Eigen::Vector3d& r) {
  const Eigen::Vector3d t = std::sqrt(sigma) * r;
  return -std::pow(sigma, 1.5) * 2 * t[1] * (4 * t[2] * t[2] - 2) * std::exp(-t.squaredNorm());
}

}  // namespace

int main(int, char** arguments) {
  // Two sources without weight make the unit cube the bounding box, as in the thesis.
  fgtd::Points<3> sources(3, count + 2);
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(count + 2, 1);
  for (int j = 0; j < count; ++j) {
    sources.col(j) << bench::halton(j, 2), bench::halton(j, 3), bench::halton(j, 5);
    weights(j, 0) = bench::halton(j, 7);
  }
  sources.col(count).setZero();
  sources.col(count + 1).setOnes();
  const fgtd::Points<3> targets = sources.leftCols(count);

  const double side = (1 + 4 * std::numeric_limits<double>::epsilon()) / 3;
  const fgtd::detail::HermitePlan plan{
      .box_scale = side, .terms = 9, .neighbours = fgtd::HermiteParameters::all_boxes};  // r = side sqrt(sigma/2)
  const auto request = fgtd::detail::make_request<3>({{{{0, 1, 2}, 1.0}}}, sigma, 3);
  fgtd::detail::Buffer<double> position;  // [3][sources]
  for (int l = 0; l < 3; ++l)
    for (Eigen::Index j = 0; j < sources.cols(); ++j) position.push_back(sources(l, j));
  std::vector<double> values(count);
  double seconds = std::numeric_limits<double>::infinity();
  for (int run = 0; run < 3; ++run)
    seconds = std::min(seconds, bench::processor_seconds([&] {
                         fgtd::detail::HermiteSum<3> sum(plan, sigma, side, position, count + 2, 1);
                         sum.set_weights(weights.data(), 1);
                         sum.evaluate(request, targets.data(), count, values.data());
                       }));

  double absolute = 0, relative = 0;
  for (int i = 0; i < count; ++i) {
    double exact = 0;
    for (int j = 0; j < count; ++j) exact += weights(j, 0) * derivative(targets.col(i) - sources.col(j));
    const double error = std::abs(values[static_cast<std::size_t>(i)] - exact);
    absolute = std::max(absolute, error);
    relative = std::max(relative, error / std::abs(exact));
  }
  std::printf("%-4s  %8.4f s   absolute error %.5e   relative error %.5e   published: %s\n", BENCH_LEVEL, seconds,
              absolute, relative, arguments[1] ? arguments[1] : "");
}
