#include "rbf/moments.hpp"

#include "rbf/derivatives.hpp"

namespace rbf::detail {

template <int d>
Moments<d>::Moments(const Polynomial& polynomial, const Points<d>& centres,
                    const Eigen::Ref<const Eigen::MatrixXd>& weights)
    : polynomial_(polynomial) {
  const Eigen::VectorXd squares = centres.colwise().squaredNorm();
  for (Eigen::Index k = 0; k < weights.cols(); ++k) {
    const auto weight = weights.col(k);
    const Eigen::VectorXd weighted = weight.cwiseProduct(squares);
    columns_.push_back({.a = weight.sum(),
                        .c = weighted.sum(),
                        .f = weighted.dot(squares),
                        .b = centres * weight,
                        .e = centres * weighted,
                        .outer = centres * weight.asDiagonal() * centres.transpose()});
  }
}

template <int d>
double Moments<d>::sum(const Derivative<d>& alpha, std::size_t column, const double* target) const {
  const Column& of = columns_[column];
  const Eigen::Map<const Vector> y(target);
  const double square = y.squaredNorm(), second = square * of.a - 2 * y.dot(of.b) + of.c;  // sum lambda r^2
  const auto [p0, p1, p2] = polynomial_;
  const int order = order_of<d>(alpha);
  if (order == 0) {
    const double fourth =
        square * (square * of.a - 4 * y.dot(of.b) + 2 * of.c) + 4 * y.dot(of.outer * y) - 4 * y.dot(of.e) + of.f;
    return p0 * of.a + p1 * second + p2 * fourth;
  }
  Eigen::Index axes[2] = {0, 0}, found = 0;
  for (Eigen::Index l = 0; l < d; ++l)
    for (int i = 0; i < alpha[static_cast<std::size_t>(l)]; ++i) axes[found++] = l;
  const Eigen::Index l = axes[0], m = axes[1];
  if (order == 1) {
    // grad r^2 = 2 (y - x), grad r^4 = 4 r^2 (y - x)
    const double fourth = y[l] * second - square * of.b[l] + 2 * of.outer.row(l).dot(y) - of.e[l];
    return 2 * p1 * (y[l] * of.a - of.b[l]) + 4 * p2 * fourth;
  }
  // Hessians: 2 I, and 4 r^2 I + 8 (y - x)(y - x)^T
  const double across = y[l] * y[m] * of.a - y[l] * of.b[m] - of.b[l] * y[m] + of.outer(l, m);
  return (l == m ? 2 * p1 * of.a + 4 * p2 * second : 0) + 8 * p2 * across;
}

template class Moments<1>;
template class Moments<2>;
template class Moments<3>;

}  // namespace rbf::detail
