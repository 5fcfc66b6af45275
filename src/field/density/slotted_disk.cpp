// The slotted disk of Zalesak as initial density.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <string>

#include "field/density/density.hpp"
#include "field/density/describe.hpp"
#include "field/density/shapes.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

using std::numbers::pi;

namespace {

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

bool SlottedDisk::fits(double radius, double slot_width, double slot_length) {
  return slot_width > 0 && slot_length > 0 && std::hypot(slot_width / 2, slot_length - radius) < radius;
}

void SlottedDisk::add(const PointsView& x, double* values) const {
  for (std::size_t i = 0; i < x.count; ++i) {
    const double dx = x.axis[0][i] - center_[0], dy = x.axis[1][i] - center_[1];
    const double dz = x.dimension == 3 ? x.axis[2][i] - center_[2] : 0;
    const bool inside = dx * dx + dy * dy + dz * dz < radius_ * radius_;
    const bool in_slot = std::abs(dx) < slot_width_ / 2 && dy < slot_length_ - radius_;
    values[i] += inside && !in_slot ? height_ : 0;
  }
}

std::string SlottedDisk::describe() const {
  return with_mass(
      fmt::format("slotted disk of Zalesak, discontinuous; centre {}, radius {:g}, slot {:g} wide and {:g} long, "
                  "height {:g}",
                  point_text(center_, dimension_), radius_, slot_width_, slot_length_, height_),
      mass());
}

// The slot covers int_{-w/2}^{w/2} (top + sqrt(r^2 - x^2)) dx of the disk, top = its inner end above the centre.
std::optional<double> SlottedDisk::mass() const {
  if (dimension_ == 3) return std::nullopt;
  const double half = slot_width_ / 2, top = slot_length_ - radius_;
  const double slot = slot_width_ * top + half * std::sqrt(radius_ * radius_ - half * half) +
                      radius_ * radius_ * std::asin(half / radius_);
  return height_ * (pi * radius_ * radius_ - slot);
}

}  // namespace

NamedShape slotted_disk() {
  return {
      NamedFormula{
          .name = "slotted_disk",
          .meaning = "Zalesak's disk with a slot that opens downwards. In 3D it is a ball, and the slot runs through "
                     "it along z",
          .formula = "height for s < 1, but 0 in the slot |x - c_x| < slot_width / 2, y - c_y < slot_length - radius",
          .parameters = {{.name = "center",
                          .kind = NamedParameter::Kind::point,
                          .unit = "length",
                          .meaning = "centre of the shape"},
                         {.name = "radius", .range = positive, .unit = "length", .meaning = "radius of the shape"},
                         {.name = "slot_width", .range = positive, .unit = "length", .meaning = "width of the slot"},
                         {.name = "slot_length",
                          .range = positive,
                          .unit = "length",
                          .meaning = "length of the slot, from the lowest point of the disk"},
                         {.name = "height", .fallback = "1", .meaning = "density outside the slot"}},
          .problem = [](int, const Arguments& a) -> std::string {
            return SlottedDisk::fits(number(a, "radius"), number(a, "slot_width"), number(a, "slot_length"))
                       ? ""
                       : "the slot cuts the disk in two: its inner corners must lie inside the disk";
          }},
      [](int dimension, const Arguments& a) {
        return std::make_unique<SlottedDisk>(dimension, point(a, "center"), number(a, "radius"),
                                             number(a, "slot_width"), number(a, "slot_length"), number(a, "height"));
      }};
}

}  // namespace gaussdrift
