// examples/scattered_data.cpp: a function from its values at random points, by the library rbf alone.
#include <cmath>
#include <iostream>
#include <rbf/integral.hpp>

int main() {
  // sin(3 x) exp(y) at 1000 random points of [0, 1]^2. A column is a point.
  const auto function = [](const rbf::Points<2>& at) -> Eigen::VectorXd {
    return ((3 * at.row(0)).array().sin() * at.row(1).array().exp()).transpose();
  };
  const rbf::Points<2> points = (rbf::Points<2>::Random(2, 1000).array() + 1) / 2;
  const rbf::Interpolant<2> fit({rbf::Kernel::thin_plate}, points, function(points));
  std::cout << fit.report() << "\n";

  // Between the points errors are smaller than those of left-out values, some of which lie at the boundary.
  const rbf::Points<2> targets = 0.4 * rbf::Points<2>::Random(2, 500).array() + 0.5;
  const double error = (fit.evaluate(targets).col(0) - function(targets)).norm() / std::sqrt(500.0);
  std::cout << "error at other points " << error << "\n";

  // The slope along x, and the integral over the square.
  const Eigen::MatrixXd slope = fit.evaluate(targets, {1, 0});
  const double exact = (1 - std::cos(3.0)) / 3 * (std::exp(1.0) - 1);
  const rbf::Integral integral = rbf::integral<2>(fit, Eigen::Vector2d(0, 0), Eigen::Vector2d(1, 1));
  std::cout << "slope at the first " << slope(0, 0) << ", integral " << integral.values[0] << ", exactly " << exact
            << "\n";
  return error < 2 * fit.report().left_out[0] && std::abs(integral.values[0] - exact) < 1e-2 ? 0 : 1;
}
