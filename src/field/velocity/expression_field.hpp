// A velocity field written as expressions.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "expression/expression.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// One expression a component, in x, y, (z,) t and the params.
class ExpressionField : public VelocityField {
 public:
  /// Throws ExpressionError.
  ExpressionField(const std::vector<std::string>& components,
                  const std::vector<std::pair<std::string, double>>& params);
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  /// Known where no component mentions its own coordinate.
  bool is_solenoidal() const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;
  bool is_steady() const override;
  bool is_smooth() const override;
  double cost() const override;
  std::string describe() const override;

 private:
  std::vector<Expression> components_;
};

}  // namespace gaussdrift
