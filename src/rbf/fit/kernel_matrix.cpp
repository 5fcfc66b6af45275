#include "rbf/fit/kernel_matrix.hpp"

#include <cmath>

namespace rbf::detail {

void to_kernel_values(const Function& function, Eigen::Ref<Eigen::MatrixXd> squared_distances) {
  const double c = function.shape;
  for (Eigen::Index j = 0; j < squared_distances.cols(); ++j) {
    auto s = squared_distances.col(j).array();
    switch (function.kernel) {
      case Kernel::gaussian:
        s = (s * (-1 / (c * c))).exp();
        break;
      case Kernel::multiquadric:
        s = (s + c * c).sqrt();
        break;
      case Kernel::inverse_multiquadric:
        s = (s + c * c).sqrt().inverse();
        break;
      case Kernel::inverse_quadratic:
        s = (s + c * c).inverse();
        break;
      case Kernel::thin_plate:
        s = 0.5 * s * s.max(1e-300).log();
        break;
      case Kernel::matern32:
        s = s.sqrt() * (std::sqrt(3.0) / c);
        s = (1 + s) * (-s).exp();
        break;
      case Kernel::matern52:
        s = s.sqrt() * (std::sqrt(5.0) / c);
        s = (1 + s + s * s / 3) * (-s).exp();
        break;
    }
  }
}

template <int d>
Eigen::MatrixXd kernel_matrix(const Function& function, const Points<d>& y, const Points<d>& x) {
  Eigen::MatrixXd matrix(y.cols(), x.cols());
  for (Eigen::Index j = 0; j < x.cols(); ++j) {
    auto column = matrix.col(j).array();
    column = (y.row(0).array() - x(0, j)).square().transpose();
    for (int l = 1; l < d; ++l) column += (y.row(l).array() - x(l, j)).square().transpose();
  }
  to_kernel_values(function, matrix);
  return matrix;
}

double sign_of(Kernel kernel) { return kernel == Kernel::multiquadric ? -1 : 1; }

template Eigen::MatrixXd kernel_matrix<1>(const Function&, const Points<1>&, const Points<1>&);
template Eigen::MatrixXd kernel_matrix<2>(const Function&, const Points<2>&, const Points<2>&);
template Eigen::MatrixXd kernel_matrix<3>(const Function&, const Points<3>&, const Points<3>&);

}  // namespace rbf::detail
