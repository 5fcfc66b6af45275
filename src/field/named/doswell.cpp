// The vortex of Doswell 1984, which rolls a front up: exact at all times.
#include <array>

#include "field/named/circular.hpp"

namespace gaussdrift::named {

namespace {

/// omega(r) = v_0 / R sech^2(r/R) tanh(r/R) / (r/R), v_0 = speed / max(sech^2 tanh) = 3 sqrt(3) / 2 speed.
struct OmegaOfDoswell {
  double radius, speed;

  std::array<double, 2> parameters() const { return {radius, 1.5 * std::numbers::sqrt3 * speed / radius}; }
  double operator()(double square) const {
    const double s = std::sqrt(square) / radius, cosine = std::cosh(s);
    const double ratio = s == 0 ? 1.0 : std::tanh(s) / s;
    return 1.5 * std::numbers::sqrt3 * speed / radius * ratio / (cosine * cosine);
  }
  // With T = tanh s, C = sech^2 s, of C T/s: C ((C s - T)/s^3 - 2 T^2/s^2) / 2R^2 for each r^2.
  double slope(double square) const {
    const double s = std::sqrt(square) / radius, cosine = std::cosh(s), c = 1 / (cosine * cosine), t = std::tanh(s);
    const double s2 = s * s;
    const bool small = s < 0.02;  // there C s - T cancels: its Taylor series
    const double difference = small ? -2. / 3 + s2 * (8. / 15 - s2 * 34 / 105) : (c * s - t) / (s2 * s);
    const double ratio = small ? 1 - s2 / 3 : t / s;
    const double of_square = c * (difference - 2 * ratio * ratio) / (2 * radius * radius);
    return 1.5 * std::numbers::sqrt3 * speed / radius * of_square;
  }
};

}  // namespace

NamedField doswell() {
  return {.about =
              NamedFormula{
                  .name = "doswell",
                  .meaning = "a vortex that rolls up a front [Dos84]. In 3D its axis is along z",
                  .formula = "with s = |x - center| / radius: circles at the speed (3 sqrt(3) / 2) speed sech^2(s) "
                             "tanh(s), counter-clockwise",
                  .parameters = {center_parameter("centre of the vortex"),
                                 {.name = "radius",
                                  .fallback = "1",
                                  .range = positive,
                                  .unit = "length",
                                  .meaning = "size of the vortex. The wind is strongest at 0.66 times this distance"},
                                 {.name = "speed",
                                  .fallback = "1",
                                  .unit = "length / time",
                                  .meaning = "speed of the strongest wind"}}},
          .divergence = "0",
          .exact_flow = "rotation about center by the angle omega(r) (t - s)",
          .make = [](int, const Arguments& a) {
            return std::make_unique<CircularField<OmegaOfDoswell>>(
                Formula::doswell, point(a, "center"), OmegaOfDoswell{number(a, "radius"), number(a, "speed")});
          }};
}

}  // namespace gaussdrift::named
