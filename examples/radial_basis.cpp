// examples/radial_basis.cpp: a sum of multiquadrics and its gradient, by the library rbf alone.
#include <cstdio>
#include <rbf/rbf.hpp>

int main() {
  // 20 000 centres in [-1, 1]^2, each with a weight.
  const int count = 20000;
  const rbf::Points<2> centres = rbf::Points<2>::Random(2, count);  // a column is a point
  const Eigen::MatrixXd weights = Eigen::MatrixXd::Random(count, 1);
  const rbf::Function multiquadric{rbf::Kernel::multiquadric, 0.3};  // sqrt(r^2 + 0.3^2)

  // The sum and its gradient at 30 000 points, in one pass.
  const rbf::Points<2> targets = 0.9 * rbf::Points<2>::Random(2, 30000);
  const rbf::Plan<2> plan(multiquadric, centres, weights,
                          {.tolerance = 1e-6, .derivative_order = 1, .expected_targets = 30000});
  const Eigen::MatrixXd values = plan.evaluate_combinations(targets, {{{{0, 0}, 1}}, {{{1, 0}, 1}}, {{{0, 1}, 1}}});

  // The same at a hundred of them by summing all pairs.
  const rbf::Points<2> few = targets.leftCols(100);
  const rbf::Plan<2> all_pairs(multiquadric, centres, weights, {.method = rbf::Method::direct});
  const double error = (all_pairs.evaluate(few) - values.topLeftCorner(100, 1)).cwiseAbs().maxCoeff();

  // What is promised: the tolerance times the largest kernel value on the range times the sum of the weights.
  const double promised = 1e-6 * plan.choice().largest * weights.cwiseAbs().sum();
  std::printf("%zu Gaussians stand for the kernel; the error at a hundred points is %s the promise\n",
              plan.choice().terms.size(), error <= promised ? "within" : "beyond");
  return error <= promised ? 0 : 1;
}
