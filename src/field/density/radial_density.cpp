#include "field/density/radial_density.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "field/density/describe.hpp"

namespace gaussdrift {

namespace {

using std::numbers::pi;
using Profile = RadialDensity::Profile;

double profile_value(Profile profile, double s) {
  const double outside = std::max(0.0, 1 - s), square = outside * outside;
  switch (profile) {
    case Profile::wendland:
      return square * square * (4 * s + 1);
    case Profile::wendland4:
      return square * square * square * ((35 * s + 18) * s + 3) / 3;
    case Profile::wendland6:
      return square * square * square * square * (((32 * s + 25) * s + 8) * s + 1);
    case Profile::cone:
      return outside;
    case Profile::gaussian:
      return std::exp(-s * s);
    case Profile::cosine_bell:
      return s < 1 ? 0.5 * (1 + std::cos(pi * s)) : 0;
    case Profile::disk:
      return s < 1 ? 1 : 0;
  }
  return 0;
}

struct ProfileFacts {
  const char* text;     // formula and smoothness
  double plane, solid;  // integral of the profile over the plane and over space, at radius 1
};

ProfileFacts facts(Profile profile) {
  switch (profile) {
    case Profile::wendland:
      return {"wendland (1-s)^4 (4s+1), twice continuously differentiable", pi / 7, 2 * pi / 21};
    case Profile::wendland4:
      return {"wendland4 (1-s)^6 (35s^2+18s+3)/3, 4 times continuously differentiable", pi / 9, 32 * pi / 495};
    case Profile::wendland6:
      return {"wendland6 (1-s)^8 (32s^3+25s^2+8s+1), 6 times continuously differentiable", 7 * pi / 78, 64 * pi / 1365};
    case Profile::cone:
      return {"cone 1-s, continuous", pi / 3, pi / 3};
    case Profile::gaussian:
      return {"gaussian exp(-s^2), smooth", pi, pi * std::sqrt(pi)};
    case Profile::cosine_bell:
      return {"cosine bell (1+cos(pi s))/2, once continuously differentiable", pi * (0.5 - 2 / (pi * pi)),
              2 * pi * (1. / 3 - 2 / (pi * pi))};
    case Profile::disk:
      return {"disk, discontinuous", pi, 4 * pi / 3};
  }
  throw std::logic_error("a density shape without facts");
}

}  // namespace

void RadialDensity::add(const PointsView& x, double* values) const {
  for (std::size_t i = 0; i < x.count; ++i) {
    double square = 0;
    for (int k = 0; k < x.dimension; ++k) {
      const double distance = (x.axis[k][i] - center_[k]) / radius_;
      square += distance * distance;
    }
    values[i] += height_ * profile_value(profile_, std::sqrt(square));
  }
}

std::string RadialDensity::describe() const {
  return with_mass(fmt::format("{}; centre {}, radius {:g}, height {:g}", facts(profile_).text,
                               point_text(center_, dimension_), radius_, height_),
                   mass());
}

std::optional<double> RadialDensity::mass() const {
  const ProfileFacts unit = facts(profile_);
  return height_ * (dimension_ == 3 ? unit.solid * radius_ * radius_ * radius_ : unit.plane * radius_ * radius_);
}

}  // namespace gaussdrift
