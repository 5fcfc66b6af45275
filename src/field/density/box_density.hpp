// A rectangle or cuboid as initial density.
#pragma once

#include <optional>
#include <string>

#include "field/density/density.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// `height` where |x_k - c_k| < lengths_k / 2 for every axis k, else 0.
class BoxDensity : public InitialDensity {
 public:
  BoxDensity(int dimension, const Vector& center, const Vector& lengths, double height)
      : dimension_(dimension), center_(center), lengths_(lengths), height_(height) {}
  void add(const PointsView& x, double* values) const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  int dimension_;
  Vector center_, lengths_;
  double height_;
};

}  // namespace gaussdrift
