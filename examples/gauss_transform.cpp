// examples/gauss_transform.cpp: the density of many Gaussian blobs and its gradient, by the library fgtd alone.
#include <cmath>
#include <cstdio>
#include <fgtd/fgtd.hpp>

int main() {
  // 20 000 blobs in [-1, 1]^2 of mass 1 together; exp(-sigma r^2) with sigma = 400 is 0.05 wide.
  const int count = 20000;
  const double sigma = 400, of_mass_1 = sigma / std::acos(-1.0);
  const fgtd::Points<2> centres = fgtd::Points<2>::Random(2, count);  // a column is a point
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Constant(count, 1, of_mass_1 / count);

  // Where the sum is wanted: a grid of 201 x 201 points. A plan made for it is the fastest.
  std::vector<double> axis;
  for (int i = 0; i <= 200; ++i) axis.push_back(-1 + 0.01 * i);
  const fgtd::TensorGrid grid{{axis, axis}};
  const fgtd::Plan<2> plan(centres, weights, sigma, {.tolerance = 1e-8, .derivative_order = 1, .expected_grid = grid});

  const Eigen::MatrixXd density = plan.evaluate(grid);             // first axis fastest
  const Eigen::MatrixXd slope = plan.evaluate(grid, {1, 0});       // its derivative along x
  const Eigen::MatrixXd few = plan.evaluate(centres.leftCols(5));  // and at any points

  // The same by summing all pairs: the oracle that every method is tested against.
  const fgtd::Plan<2> all_pairs(centres, weights, sigma, {.method = fgtd::Method::direct});
  const double error = (all_pairs.evaluate(centres.leftCols(5)) - few).cwiseAbs().maxCoeff();

  std::printf("largest density %.4f, steepest slope %.3f, error at five points %.1e\n", density.maxCoeff(),
              slope.cwiseAbs().maxCoeff(), error);
  return error <= 1e-8 ? 0 : 1;
}
