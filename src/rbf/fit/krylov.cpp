#include "rbf/fit/krylov.hpp"

#include <Eigen/Jacobi>
#include <cmath>
#include <vector>

namespace rbf::detail {

using Index = Eigen::Index;

Coefficients flexible_gmres(const Operators& operators, const Eigen::VectorXd& values, double factor,
                            int most_iterations, int& iterations) {
  const double size = values.norm();
  std::vector<Eigen::VectorXd> basis{values / size};
  std::vector<Coefficients> directions;
  std::vector<Eigen::JacobiRotation<double>> rotations;
  // The matrix of Hessenberg's form, which rotations make triangular, and the values in the basis.
  Eigen::MatrixXd upper = Eigen::MatrixXd::Zero(most_iterations + 1, most_iterations);
  Eigen::VectorXd right = Eigen::VectorXd::Zero(most_iterations + 1);
  right[0] = size;
  Index steps = 0;
  while (steps < most_iterations && std::abs(right[steps]) > factor * size) {
    directions.push_back(operators.preconditioner(basis.back()));
    Eigen::VectorXd next = operators.product(directions.back());
    for (int pass = 0; pass < 2; ++pass)  // the second takes away what rounding leaves
      for (std::size_t i = 0; i < basis.size(); ++i) {
        const double along = basis[i].dot(next);
        next -= along * basis[i];
        upper(static_cast<Index>(i), steps) += along;
      }
    const double length = next.norm();
    upper(steps + 1, steps) = length;
    for (std::size_t i = 0; i < rotations.size(); ++i)
      upper.col(steps).applyOnTheLeft(static_cast<Index>(i), static_cast<Index>(i) + 1, rotations[i].adjoint());
    Eigen::JacobiRotation<double> rotation;
    rotation.makeGivens(upper(steps, steps), upper(steps + 1, steps));
    upper.col(steps).applyOnTheLeft(steps, steps + 1, rotation.adjoint());
    right.applyOnTheLeft(steps, steps + 1, rotation.adjoint());
    rotations.push_back(rotation);
    ++steps;
    ++iterations;
    if (!(length > 0)) break;
    basis.push_back(next / length);
  }
  const Eigen::VectorXd y = upper.topLeftCorner(steps, steps).triangularView<Eigen::Upper>().solve(right.head(steps));
  Coefficients sum = directions.front();
  sum.weights *= y[0];
  sum.polynomial *= y[0];
  for (Index i = 1; i < steps; ++i) {
    sum.weights += y[i] * directions[static_cast<std::size_t>(i)].weights;
    sum.polynomial += y[i] * directions[static_cast<std::size_t>(i)].polynomial;
  }
  return sum;
}

}  // namespace rbf::detail
