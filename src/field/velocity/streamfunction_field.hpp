// A velocity field in the plane, written as its streamfunction.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "expression/expression.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// 2D: u = d psi / dy, v = -d psi / dx with psi in x, y, t and the params; div u = 0 wherever psi is smooth.
/// Expression::rough_spots says what is taken elsewhere.
class StreamfunctionField : public VelocityField {
 public:
  /// `length` is that of the domain. Throws ExpressionError.
  StreamfunctionField(const std::string& psi, const std::vector<std::pair<std::string, double>>& params,
                      double length = 1);
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  /// Differences of the exact slopes of psi, of order 6 over 3/1024 of `length` to either side.
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;
  bool is_steady() const override;
  bool is_smooth() const override;
  bool is_solenoidal() const override { return true; }
  double cost() const override;
  std::string describe() const override;

 private:
  Expression psi_;
  double length_;
};

}  // namespace gaussdrift
