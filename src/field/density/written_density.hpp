// An initial density written as an expression.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "expression/expression.hpp"
#include "field/density/density.hpp"

namespace gaussdrift {

/// An expression in x, y, (z) and the params.
class WrittenDensity : public InitialDensity {
 public:
  /// Throws ExpressionError.
  WrittenDensity(const std::string& text, int dimension, const std::vector<std::pair<std::string, double>>& params);
  void add(const PointsView& x, double* values) const override;
  double cost() const override;
  std::string describe() const override;

 private:
  Expression expression_;
};

}  // namespace gaussdrift
