#include "rbf/fit/dense_system.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "rbf/fit/kernel_matrix.hpp"

namespace rbf::detail {

DenseSystem::DenseSystem(Eigen::MatrixXd matrix, const Eigen::MatrixXd& polynomials, double sign, double ridge)
    : sign_(sign) {
  const Eigen::Index count = matrix.rows(), size = polynomials.cols();
  determined_ = count > size;
  if (!determined_) return;
  matrix.diagonal().array() += ridge;
  if (size > 0) {
    polynomials_.compute(polynomials);
    const Eigen::VectorXd diagonal = polynomials_.matrixQR().diagonal().cwiseAbs();
    determined_ = diagonal.minCoeff() > 1e-10 * diagonal.maxCoeff();
    if (!determined_) return;
    // Q is a product of `size` reflections, so both sides cost little.
    const auto q = polynomials_.householderQ();
    matrix.applyOnTheLeft(q.adjoint());
    matrix.applyOnTheRight(q);
    coupling_ = matrix.topRightCorner(size, count - size);
  }
  factors_.compute(matrix.bottomRightCorner(count - size, count - size));
}

double DenseSystem::reciprocal_condition() const { return factors_.info() == Eigen::Success ? factors_.rcond() : 0; }

Coefficients DenseSystem::solve(const Eigen::MatrixXd& values) const {
  const Eigen::Index size = coupling_.rows();
  Coefficients found;
  if (size == 0) {
    found.weights = sign_ * factors_.solve(values);
    found.polynomial.resize(0, values.cols());
    return found;
  }
  const auto q = polynomials_.householderQ();
  Eigen::MatrixXd turned = values;
  turned.applyOnTheLeft(q.adjoint());
  const Eigen::MatrixXd y = factors_.solve(turned.bottomRows(turned.rows() - size));
  found.polynomial = polynomials_.matrixQR().topRows(size).template triangularView<Eigen::Upper>().solve(
      turned.topRows(size) - coupling_ * y);
  turned.topRows(size).setZero();
  turned.bottomRows(turned.rows() - size) = sign_ * y;
  turned.applyOnTheLeft(q);
  found.weights = std::move(turned);
  return found;
}

double DenseSystem::Gaussian::log_likelihood(Eigen::Index k) const {
  const double m = static_cast<double>(numbers);
  return -0.5 * (m * (std::log(2 * std::numbers::pi * squares[k] / m) + 1) + log_determinant);
}

DenseSystem::Gaussian DenseSystem::gaussian(const Eigen::MatrixXd& values, const Coefficients& solution) const {
  Gaussian found;
  found.numbers = factors_.rows();
  found.log_determinant = 2 * factors_.matrixLLT().diagonal().array().log().sum();
  found.squares = sign_ * values.cwiseProduct(solution.weights).colwise().sum();
  return found;
}

Eigen::MatrixXd DenseSystem::reduced_rows(const std::vector<Eigen::Index>& rows) const {
  const Eigen::Index size = coupling_.rows(), count = factors_.rows() + size;
  Eigen::MatrixXd units = Eigen::MatrixXd::Zero(count, static_cast<Eigen::Index>(rows.size()));
  for (std::size_t i = 0; i < rows.size(); ++i) units(rows[i], static_cast<Eigen::Index>(i)) = 1;
  if (size > 0) units.applyOnTheLeft(polynomials_.householderQ().adjoint());
  return units.bottomRows(count - size);
}

Eigen::MatrixXd DenseSystem::weight_rows(const std::vector<Eigen::Index>& rows) const {
  const Eigen::Index size = coupling_.rows();
  const Eigen::MatrixXd solved = sign_ * factors_.solve(reduced_rows(rows));
  if (size == 0) return solved.transpose();
  Eigen::MatrixXd turned = Eigen::MatrixXd::Zero(solved.rows() + size, solved.cols());
  turned.bottomRows(solved.rows()) = solved;
  turned.applyOnTheLeft(polynomials_.householderQ());
  return turned.transpose();
}

Eigen::VectorXd DenseSystem::weight_diagonal() const {
  // G_ii is the square of the length of L^-1 Q2^T e_i, where B = L L^T.
  const Eigen::Index count = factors_.rows() + coupling_.rows();
  Eigen::VectorXd diagonal(count);
  constexpr Eigen::Index piece = 256;
  for (Eigen::Index begin = 0; begin < count; begin += piece) {
    std::vector<Eigen::Index> rows;
    for (Eigen::Index i = begin; i < std::min(count, begin + piece); ++i) rows.push_back(i);
    const Eigen::MatrixXd solved = factors_.matrixL().solve(reduced_rows(rows));
    diagonal.segment(begin, solved.cols()) = sign_ * solved.colwise().squaredNorm().transpose();
  }
  return diagonal;
}

template <int d>
DenseSystem DenseSystem::of(const Function& function, const Points<d>& points, const Frame<d>& frame, double ridge) {
  const double sign = sign_of(function.kernel);
  return {sign * kernel_matrix<d>(function, points, points), frame.values(points), sign, ridge};
}

template DenseSystem DenseSystem::of<1>(const Function&, const Points<1>&, const Frame<1>&, double);
template DenseSystem DenseSystem::of<2>(const Function&, const Points<2>&, const Frame<2>&, double);
template DenseSystem DenseSystem::of<3>(const Function&, const Points<3>&, const Frame<3>&, double);

}  // namespace rbf::detail
