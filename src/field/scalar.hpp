// Scalar fields of place and time: rates at which weights change.
#pragma once

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "expression/expression.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// A field is immutable; `add` is safe to call from several threads.
class ScalarField {
 public:
  virtual ~ScalarField() = default;
  /// values[i] += f(x_i, t). Values that are not finite are passed on; the caller reports them with place and time.
  virtual void add(double t, const PointsView& x, double* values) const = 0;
  /// True if it does not depend on t.
  virtual bool is_steady() const = 0;
  /// False if it or a derivative of it jumps somewhere.
  virtual bool is_smooth() const = 0;
  /// The rough cost of a value, in values of a formula with a sine or two.
  virtual double cost() const { return 1; }
  /// Its formula.
  virtual std::string describe() const = 0;
};

/// An expression in x, y, (z,) t and the params. One without x, y, z, t is computed once.
class WrittenScalar : public ScalarField {
 public:
  /// Throws ExpressionError.
  WrittenScalar(const std::string& text, int dimension, const std::vector<std::pair<std::string, double>>& params);
  void add(double t, const PointsView& x, double* values) const override;
  bool is_steady() const override { return steady_; }
  bool is_smooth() const override { return expression_.rough_spots().empty(); }
  double cost() const override { return std::max(1.0, expression_.cost()); }
  std::string describe() const override { return expression_.text(); }

 private:
  Expression expression_;
  bool constant_, steady_;
  double value_ = 0;  // if constant
};

/// The sum of at least one field.
class SumOfScalars : public ScalarField {
 public:
  explicit SumOfScalars(std::vector<std::unique_ptr<ScalarField>> fields) : fields_(std::move(fields)) {}
  void add(double t, const PointsView& x, double* values) const override {
    for (const auto& field : fields_) field->add(t, x, values);
  }
  bool is_steady() const override {
    return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_steady(); });
  }
  bool is_smooth() const override {
    return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_smooth(); });
  }
  double cost() const override;
  std::string describe() const override;

 private:
  std::vector<std::unique_ptr<ScalarField>> fields_;
};

}  // namespace gaussdrift
