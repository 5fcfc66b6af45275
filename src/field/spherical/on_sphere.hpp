// Velocities on a sphere, whose places are longitudes and latitudes in degrees. Particles are carried in these coordinates,
// so that steps, paths, folding and data on grids need not know of the sphere. docs/method.md, section 18.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// Nobody goes nearer to a pole than that, in degrees: there the longitude runs round faster than any step.
constexpr double nearest_to_pole = 0.1;

/// Another field, asked in the same way; a class beneath says what it does with the values.
class VelocityOfOther : public VelocityField {
 public:
  explicit VelocityOfOther(const VelocityField& field) : field_(field) {}
  bool is_steady() const override { return field_.is_steady(); }
  bool is_smooth() const override { return field_.is_smooth(); }
  bool evaluates_in_blocks() const override { return field_.evaluates_in_blocks(); }
  double held_until(double t) const override { return field_.held_until(t); }
  double held_since(double t) const override { return field_.held_since(t); }
  double cost() const override { return field_.cost() + 1; }
  double shown_time(double t) const override { return field_.shown_time(t); }
  std::string why_not_finite(double t, const Vector& x) const override { return field_.why_not_finite(t, x); }
  std::string describe() const override { return field_.describe(); }

 protected:
  const VelocityField& other() const { return field_; }

 private:
  const VelocityField& field_;
};

/// What a part of a case gives, as degrees per time:
///   components u to the east and v to the north, lengths per time:  dx/dt = k u / cos y,  dy/dt = k v;
///   a streamfunction, as the field (psi_y, -psi_x) of degrees:      dx/dt = k^2 psi_y / cos y,  dy/dt = -k^2 psi_x / cos y,
/// k = 180 / (pi radius). Its divergence and gradient are those of the coordinates.
class DegreesVelocity : public VelocityOfOther {
 public:
  enum class Of { components, streamfunction };
  DegreesVelocity(std::unique_ptr<VelocityField> field, Of kind, double radius);
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;

 private:
  std::unique_ptr<VelocityField> field_;
  Of kind_;
  double degrees_;  // of a length of 1
};

/// A flow in degrees per time as what it is in lengths: to the east and to the north, with the gradient of the sphere
/// (covariant, of lengths by lengths).
class LengthsVelocity : public VelocityOfOther {
 public:
  LengthsVelocity(const VelocityField& field, double radius) : VelocityOfOther(field), radius_(radius) {}
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;

 private:
  double radius_;
};

/// All of a case's flow, in degrees per time. Its divergence is that of the sphere, d u_x/dx + d u_y/dy - u_y tan y, its
/// gradient that of the coordinates. Not a number near the poles.
class SphereVelocity : public VelocityOfOther {
 public:
  /// solenoidal: there is no divergence on the sphere.
  SphereVelocity(std::unique_ptr<VelocityField> field, double radius, bool solenoidal);
  void add(double t, const PointsView& x, const VectorsView& u) const override;
  void add_divergence(double t, const PointsView& x, double* values) const override;
  void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const override;
  bool is_solenoidal() const override { return solenoidal_; }
  const VelocityField& shown() const override { return shown_; }
  const VelocityField& in_lengths() const override { return lengths_; }
  std::string why_not_finite(double t, const Vector& x) const override;

 private:
  std::unique_ptr<VelocityField> field_;
  bool solenoidal_;
  LengthsVelocity lengths_, shown_;
};

}  // namespace gaussdrift
