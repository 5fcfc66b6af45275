// Initial densities that depend on the distance from a centre alone.
#pragma once

#include <optional>
#include <string>

#include "field/density/density.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// height * profile(s), s = |x - center| / radius, in 2D and 3D.
class RadialDensity : public InitialDensity {
 public:
  enum class Profile {
    wendland,     // (1-s)^4_+ (4s+1), twice continuously differentiable [Sch06, 5.3.2], [Wen95]
    wendland4,    // (1-s)^6_+ (35 s^2 + 18 s + 3) / 3, four times
    wendland6,    // (1-s)^8_+ (32 s^3 + 25 s^2 + 8 s + 1), six times
    cone,         // (1-s)_+, continuous
    gaussian,     // exp(-s^2), smooth
    cosine_bell,  // (1 + cos(pi s)) / 2 for s < 1, else 0; once
    disk          // 1 for s < 1, else 0; discontinuous. In 3D a ball
  };
  RadialDensity(Profile profile, int dimension, const Vector& center, double radius, double height)
      : profile_(profile), dimension_(dimension), center_(center), radius_(radius), height_(height) {}
  void add(const PointsView& x, double* values) const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  Profile profile_;
  int dimension_;
  Vector center_;
  double radius_, height_;
};

}  // namespace gaussdrift
