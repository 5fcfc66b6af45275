// Initial densities rho_0(x): radial shapes, expressions, and their sum.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/points.hpp"
#include "expression/expression.hpp"

namespace gaussdrift {

/// A density is immutable; `add` is safe to call from several threads.
class InitialDensity {
 public:
  virtual ~InitialDensity() = default;
  /// values[i] += rho_0(x_i). Values that are not finite are passed on; the caller reports them with their place.
  virtual void add(const PointsView& x, double* values) const = 0;
};

/// height * profile(|x - center| / radius).
class RadialDensity : public InitialDensity {
 public:
  enum class Profile {
    wendland,  // (1-s)^4_+ (4s+1), twice continuously differentiable [Sch06, 5.3.2]
    cone,      // (1-s)_+
    gaussian,  // exp(-s^2)
    disk       // 1 for s < 1, else 0
  };
  RadialDensity(Profile profile, const Vector& center, double radius, double height)
      : profile_(profile), center_(center), radius_(radius), height_(height) {}
  void add(const PointsView& x, double* values) const override;

 private:
  Profile profile_;
  Vector center_;
  double radius_, height_;
};

/// An expression in x, y, (z) and the params.
class WrittenDensity : public InitialDensity {
 public:
  /// Throws ExpressionError.
  WrittenDensity(const std::string& text, int dimension, const std::vector<std::pair<std::string, double>>& params);
  void add(const PointsView& x, double* values) const override;

 private:
  Expression expression_;
};

class SumDensity : public InitialDensity {
 public:
  explicit SumDensity(std::vector<std::unique_ptr<InitialDensity>> parts) : parts_(std::move(parts)) {}
  void add(const PointsView& x, double* values) const override {
    for (const auto& part : parts_) part->add(x, values);
  }

 private:
  std::vector<std::unique_ptr<InitialDensity>> parts_;
};

}  // namespace gaussdrift
