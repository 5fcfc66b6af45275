// Polynomials of degree below m = 0, 1, 2 in coordinates around the middle of some points, in units of their extent.
#pragma once

#include "rbf/rbf.hpp"

namespace rbf::detail {

template <int d>
class Frame {
 public:
  using Vector = Eigen::Matrix<double, d, 1>;

  Frame() = default;
  /// @param order  m: 0 none, 1 constants, 2 linear polynomials
  Frame(const Points<d>& points, int order) : order_(order) {
    if (points.cols() == 0) return;
    const Vector low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
    middle_ = low + (high - low) / 2;
    const double extent = (high - low).maxCoeff() / 2;
    if (extent > 0) unit_ = extent;
  }

  /// Number of polynomials.
  Eigen::Index size() const { return order_ == 0 ? 0 : order_ == 1 ? 1 : 1 + d; }

  /// Their values at points, as rows: 1, then the coordinates.
  Eigen::MatrixXd values(const Points<d>& points) const {
    Eigen::MatrixXd found(points.cols(), size());
    if (order_ >= 1) found.col(0).setOnes();
    if (order_ >= 2) found.rightCols(d) = (points.colwise() - middle_).transpose() / unit_;
    return found;
  }

  const Vector& middle() const { return middle_; }
  double unit() const { return unit_; }

 private:
  int order_ = 0;
  Vector middle_ = Vector::Zero();
  double unit_ = 1;
};

}  // namespace rbf::detail
