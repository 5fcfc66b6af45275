// Velocity fields u(x, t): the prescribed flow that carries the particles.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/points.hpp"
#include "expression/expression.hpp"

namespace gaussdrift {

/// A field is immutable; `add` is safe to call from several threads.
class VelocityField {
 public:
  virtual ~VelocityField() = default;
  /// u[k][i] += u_k(x_i, t). Values that are not finite are passed on; the caller reports them with place and time.
  virtual void add(double t, const PointsView& x, const VectorsView& u) const = 0;
  /// One line for people: formula and what is known of it.
  virtual std::string describe() const = 0;
};

/// Rigid rotation, counter-clockwise: u = rate (-(y - c_y), x - c_x), and 0 along z. div u = 0; the exact flow is
/// x(t) = c + R(rate t) (x(0) - c).
class RotationField : public VelocityField {
 public:
  RotationField(int dimension, const Vector& center, double rate)
      : dimension_(dimension), center_(center), rate_(rate) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  std::string describe() const override;

 private:
  int dimension_;
  Vector center_;
  double rate_;
};

/// One expression a component, in x, y, (z,) t and the params.
class ExpressionField : public VelocityField {
 public:
  /// Throws ExpressionError.
  ExpressionField(const std::vector<std::string>& components,
                  const std::vector<std::pair<std::string, double>>& params);
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  std::string describe() const override;

 private:
  std::vector<Expression> components_;
};

/// The sum of several fields.
class SumField : public VelocityField {
 public:
  explicit SumField(std::vector<std::unique_ptr<VelocityField>> fields) : fields_(std::move(fields)) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  std::string describe() const override;

 private:
  std::vector<std::unique_ptr<VelocityField>> fields_;
};

}  // namespace gaussdrift
