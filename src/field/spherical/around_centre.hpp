// Shapes of density on a sphere.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "field/density/density.hpp"

namespace gaussdrift {

/// A shape about the origin of a plane, laid on a sphere: its plane is the map that keeps distances from `centre` and
/// directions there (azimuthal equidistant), x to the east, y to the north. So what depends on the distance from the
/// centre depends on the length of the great circle.
class DensityAroundCentre : public InitialDensity {
 public:
  /// centre: longitude and latitude in degrees.
  DensityAroundCentre(std::unique_ptr<InitialDensity> shape, const Vector& centre, double radius)
      : shape_(std::move(shape)), centre_(centre), radius_(radius) {}
  void add(const PointsView& x, double* values) const override;
  double cost() const override { return shape_->cost() + 3; }
  std::string describe() const override;

 private:
  std::unique_ptr<InitialDensity> shape_;
  Vector centre_;
  double radius_;
};

}  // namespace gaussdrift
