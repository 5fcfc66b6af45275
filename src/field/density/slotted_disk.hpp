// The slotted disk of Zalesak as initial density.
#pragma once

#include <optional>
#include <string>

#include "field/density/density.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// Zalesak's disk: `height` for |x - center| < radius but outside the slot |x - c_x| < slot_width / 2,
/// y - c_y < slot_length - radius, which opens downwards. In 3D a ball, and the slot runs through along z.
class SlottedDisk : public InitialDensity {
 public:
  /// The inner end of the slot must lie inside the disk, as fits() says.
  SlottedDisk(int dimension, const Vector& center, double radius, double slot_width, double slot_length, double height)
      : dimension_(dimension),
        center_(center),
        radius_(radius),
        slot_width_(slot_width),
        slot_length_(slot_length),
        height_(height) {}
  /// Do the corners at the inner end of the slot lie inside the disk?
  static bool fits(double radius, double slot_width, double slot_length);
  void add(const PointsView& x, double* values) const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  int dimension_;
  Vector center_;
  double radius_, slot_width_, slot_length_, height_;
};

}  // namespace gaussdrift
