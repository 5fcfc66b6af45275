#include "field/density/box_density.hpp"

#include <fmt/format.h>

#include <cmath>

#include "field/density/describe.hpp"

namespace gaussdrift {

void BoxDensity::add(const PointsView& x, double* values) const {
  for (std::size_t i = 0; i < x.count; ++i) {
    bool inside = true;
    for (int k = 0; k < x.dimension; ++k) inside = inside && std::abs(x.axis[k][i] - center_[k]) < lengths_[k] / 2;
    values[i] += inside ? height_ : 0;
  }
}

std::string BoxDensity::describe() const {
  return with_mass(fmt::format("box, discontinuous; centre {}, lengths {}, height {:g}",
                               point_text(center_, dimension_), point_text(lengths_, dimension_), height_),
                   mass());
}

std::optional<double> BoxDensity::mass() const {
  double volume = height_;
  for (int k = 0; k < dimension_; ++k) volume *= lengths_[k];
  return volume;
}

}  // namespace gaussdrift
