// Velocity fields u(x, t): the prescribed flow that carries the particles.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// d u_k / d x_i at many points: slope[k][i] is an array of them, null beyond the dimension.
struct GradientsView {
  int dimension = 0;
  std::size_t count = 0;
  std::array<std::array<double*, max_dimension>, max_dimension> slope{};
  GradientsView block(std::size_t first, std::size_t length) const {
    GradientsView part{dimension, length, {}};
    for (int k = 0; k < dimension; ++k)
      for (int i = 0; i < dimension; ++i) part.slope[k][i] = slope[k][i] + first;
    return part;
  }
};

class BlockCarrier;  // block_carrier.hpp

/// A field is immutable; everything here is safe to call from several threads.
class VelocityField {
 public:
  virtual ~VelocityField() = default;
  /// u[k][i] += u_k(x_i, t). Values that are not finite are passed on; the caller reports them with place and time.
  virtual void add(double t, const PointsView& x, const VectorsView& u) const = 0;
  /// values[i] += div u(x_i, t), by the derivatives of the field's own formula. Not finite where they are not.
  virtual void add_divergence(double t, const PointsView& x, double* values) const = 0;
  /// gradients.slope[k][i][j] += d u_k / d x_i at (x_j, t), likewise.
  virtual void add_gradient(double t, const PointsView& x, const GradientsView& gradients) const = 0;
  /// True if u does not depend on t.
  virtual bool is_steady() const { return false; }
  /// False if u or a derivative of it jumps somewhere. Methods of high order take short steps there.
  virtual bool is_smooth() const { return true; }
  /// True if div u = 0 everywhere, by construction.
  virtual bool is_solenoidal() const { return false; }
  /// The position at time `to` of a particle that is at x at time `from`, if the flow has a known closed
  /// form.
  virtual std::optional<Vector> flow(double /*from*/, double /*to*/, const Vector& /*x*/) const { return std::nullopt; }
  /// True if a point costs no more in calls for a few hundred points than in one call for all.
  virtual bool evaluates_in_blocks() const { return true; }
  /// What carries blocks of particles through many steps at once, if the field has a kernel for that; else null.
  virtual const BlockCarrier* block_carrier() const { return nullptr; }
  /// Until when values from `t` on may be asked for in any order. Beyond, a field that reads its data on the way may have
  /// to read them twice: then all points go as far as that before any goes on.
  virtual double held_until(double /*t*/) const { return std::numeric_limits<double>::infinity(); }
  /// The same backwards: since when values up to `t` may be asked for.
  virtual double held_since(double /*t*/) const { return -std::numeric_limits<double>::infinity(); }
  /// What the clock of the case shows at `t`, for messages.
  virtual double shown_time(double t) const { return t; }
  /// The field as people know it: at times of the clock, and not turned round.
  virtual const VelocityField& shown() const { return *this; }
  /// The same flow as lengths per time, and its gradient by lengths. On a sphere, where u is in degrees per time, these are
  /// the components to the east and to the north; elsewhere it is the field itself.
  virtual const VelocityField& in_lengths() const { return *this; }
  /// What a value costs, roughly, in values of a formula with a sine or two.
  virtual double cost() const { return 1; }
  /// True if u, or a part of it, is fitted to samples.
  virtual bool is_fitted() const { return false; }
  /// The error of the fit near some points, estimated as a root mean square; 0 where u is a formula.
  virtual double fit_error(const PointsView& /*near*/) const { return 0; }
  /// Why u is not finite at x, and what can be done, for a message. Empty if the field knows no reason.
  virtual std::string why_not_finite(double /*t*/, const Vector& /*x*/) const { return ""; }
  /// One line for people: formula and what is known of it.
  virtual std::string describe() const = 0;
};

}  // namespace gaussdrift
