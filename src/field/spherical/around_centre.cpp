#include "field/spherical/around_centre.hpp"

#include <fmt/format.h>

#include <cmath>
#include <vector>

#include "base/sphere.hpp"

namespace gaussdrift {

void DensityAroundCentre::add(const PointsView& x, double* values) const {
  std::vector<double> east(x.count), north(x.count);
  const double c0 = std::cos(radians(centre_[1])), s0 = std::sin(radians(centre_[1]));
  for (std::size_t i = 0; i < x.count; ++i) {
    const Vector place = x.at(i);
    const double lambda = radians(place[0] - centre_[0]), phi = radians(place[1]), c = std::cos(phi);
    // The direction at the centre, and the length of the way.
    const double to_east = c * std::sin(lambda), to_north = c0 * std::sin(phi) - s0 * c * std::cos(lambda);
    const double size = std::hypot(to_east, to_north);
    const double length = radius_ * angle_between(centre_, place);
    east[i] = size > 0 ? length * (to_east / size) : length;
    north[i] = size > 0 ? length * (to_north / size) : 0;
  }
  shape_->add({2, x.count, {east.data(), north.data()}}, values);
}

std::string DensityAroundCentre::describe() const {
  std::string text = shape_->describe();
  // What it weighs in the plane is not what it weighs here.
  if (const std::size_t mass = text.rfind(", mass "); mass != std::string::npos) text.erase(mass);
  if (const std::size_t centre = text.find("centre (0, 0), "); centre != std::string::npos) text.erase(centre, 15);
  return fmt::format("{}, around the longitude {:g} and latitude {:g} along great circles", text, centre_[0],
                     centre_[1]);
}

}  // namespace gaussdrift
