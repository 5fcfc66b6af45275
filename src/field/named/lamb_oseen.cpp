// The vortex of Lamb and Oseen at one moment: a Gaussian of vorticity, frozen.
#include <array>

#include "field/named/circular.hpp"

namespace gaussdrift::named {

namespace {

/// omega(r) = circulation / (2 pi r^2) (1 - exp(-r^2 / radius^2)).
struct OmegaOfLambOseen {
  double circulation, radius;

  std::array<double, 2> parameters() const {
    return {radius * radius, circulation / (2 * std::numbers::pi * (radius * radius))};
  }
  double operator()(double square) const {
    const double core = radius * radius;
    return circulation / (2 * std::numbers::pi * core) * gaussian_swirl(square / core);
  }
  double slope(double square) const {
    const double core = radius * radius;
    return circulation / (2 * std::numbers::pi * core * core) * gaussian_swirl_slope(square / core);
  }
};

}  // namespace

NamedField lamb_oseen() {
  return {.about =
              NamedFormula{
                  .name = "lamb_oseen",
                  .meaning = "a vortex with a Gaussian core, frozen in time. In 3D its axis is along z",
                  .formula = "circles at the speed circulation / (2 pi r) (1 - exp(-r^2 / radius^2)), r = |x - center|",
                  .parameters = {center_parameter("centre of the vortex"),
                                 {.name = "circulation",
                                  .fallback = "1",
                                  .unit = "length^2 / time",
                                  .symbol = "Gamma",
                                  .meaning = "circulation of the vortex, counter-clockwise"},
                                 {.name = "radius",
                                  .fallback = "1",
                                  .range = positive,
                                  .unit = "length",
                                  .symbol = "2 sqrt(nu t)",
                                  .meaning = "radius of the core"}}},
          .divergence = "0",
          .exact_flow = "rotation about center by the angle omega(r) (t - s)",
          .make = [](int, const Arguments& a) {
            return std::make_unique<CircularField<OmegaOfLambOseen>>(
                Formula::lamb_oseen, point(a, "center"),
                OmegaOfLambOseen{number(a, "circulation"), number(a, "radius")});
          }};
}

}  // namespace gaussdrift::named
