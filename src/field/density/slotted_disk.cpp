#include "field/density/slotted_disk.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "field/density/describe.hpp"

namespace gaussdrift {

using std::numbers::pi;

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

}  // namespace gaussdrift
