// Initial densities rho_0(x).
#pragma once

#include <optional>
#include <string>

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// A density is immutable; `add` is safe to call from several threads.
class InitialDensity {
 public:
  virtual ~InitialDensity() = default;
  /// values[i] += rho_0(x_i). Values that are not finite are passed on; the caller reports them with their place.
  virtual void add(const PointsView& x, double* values) const = 0;
  /// The rough cost of a value, in values of a formula with a sine or two.
  virtual double cost() const { return 1; }
  /// The largest error of its values, estimated, where they are fitted to samples; 0 where they are a formula.
  virtual double fit_error() const { return 0; }
  /// One line for people: formula, smoothness, and the mass where it is known.
  virtual std::string describe() const = 0;
  /// The integral over all space; nothing where no closed form is known.
  virtual std::optional<double> mass() const { return std::nullopt; }
};

}  // namespace gaussdrift
