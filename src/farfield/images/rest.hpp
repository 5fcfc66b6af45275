// The images beyond the nearest, for all points together: their potential is that of the background and a polynomial which
// is harmonic, in x - y and so in x and in y. Moments of the sources become coefficients of the potential by the addition
// theorem of these polynomials.
#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "farfield/images/copies.hpp"

namespace farfield::detail {

/// What is known of the rest before the points are.
template <int d>
class RestShape {
 public:
  /// Equal axes and tolerances share one as long as somebody holds it. `tolerable`: the error in field and potential of a
  /// charge, relative to what the promise is relative to. Throws ToleranceError.
  static std::shared_ptr<const RestShape> get(const Copies<d>& copies, double tolerable);
  RestShape(const Copies<d>& copies, double tolerable);

  int degree() const { return degree_; }
  /// By the image's turn, then by function (harmonics.hpp), in coordinates scale() z.
  const std::vector<std::vector<double>>& polynomials() const { return polynomials_; }
  double scale() const { return scale_; }
  /// Laplacian of the potential of each turn.
  double laplacian() const { return laplacian_; }
  /// Measured, in the same units as `tolerable`.
  double error() const { return error_; }

 private:
  bool fits(const std::array<CopiedAxis, 3>& axes, double charge, double tolerable) const;

  std::array<CopiedAxis, 3> axes_;
  double charge_;  // of the last turn: shapes of equal and of opposite images have their own
  double tolerable_;
  int degree_ = 0;
  double scale_ = 1, laplacian_ = 0, error_ = 0;
  std::vector<std::vector<double>> polynomials_;
};

template <int d>
class Rest {
 public:
  Rest(const Copies<d>& copies, std::shared_ptr<const RestShape<d>> shape)
      : copies_(copies), shape_(std::move(shape)) {}

  /// Adds potential and field, minus its gradient, of the charges at the sources. Points lie in the box.
  void add(const Points<d>& sources, const Eigen::Ref<const Eigen::VectorXd>& charges, const Points<d>& targets,
           int threads, Eigen::VectorXd* potential, Points<d>& field) const;

  const RestShape<d>& shape() const { return *shape_; }

 private:
  struct Sums;
  Sums moments(const Points<d>& sources, const Eigen::Ref<const Eigen::VectorXd>& charges, int threads) const;
  std::vector<double> local(const std::vector<double>& moments) const;

  Copies<d> copies_;
  std::shared_ptr<const RestShape<d>> shape_;
};

}  // namespace farfield::detail
