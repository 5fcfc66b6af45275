#include <algorithm>
#include <cmath>
#include <limits>

#include "render/picture.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

namespace {

/// The next of 1, 2 and 5 times a power of ten, and at most `most`.
double rounded_up(double x, double most) {
  const double exponent = std::floor(std::log10(x)), power = std::pow(10., std::fabs(exponent));
  for (const double factor : {1., 2., 5., 10.}) {
    const double round = exponent < 0 ? factor / power : factor * power;  // 2 / 100 is 0.02
    if (round >= x) return std::min(round, most);
  }
  return most;
}

}  // namespace

std::pair<double, double> rounded_range(double minimum, double maximum) {
  if (!std::isfinite(minimum) || !std::isfinite(maximum)) return {0, 1};
  if (minimum > maximum) std::swap(minimum, maximum);
  if (minimum == 0 && maximum == 0) return {0, 1};

  // 0 becomes an end if the values start near it, or if they cross it by no more than the overshoot of a smoothed step.
  constexpr double near = 0.25, overshoot = 0.01;
  const double size = std::max(std::fabs(minimum), std::fabs(maximum));
  if (minimum > -overshoot * size && minimum < near * size) minimum = 0;
  if (maximum < overshoot * size && maximum > -near * size) maximum = 0;
  if (minimum == maximum) (minimum > 0 ? minimum : maximum) = 0;  // a constant: from 0 to there

  // Ends are multiples of a tenth or so of the range, and may leave out 1 % of it.
  const double rough = (maximum - minimum) / 10;
  const double power = std::pow(10., std::floor(std::log10(rough) + 1e-9));
  if (!(power > 0) || !std::isfinite(rough)) return {minimum, maximum};
  double step = 10 * power;
  for (const double factor : {5., 2., 1.})
    if (factor * power >= rough * (1 - 1e-9)) step = factor * power;
  const double slack = overshoot * (maximum - minimum) / step;
  const auto times_step = [&](double count) {  // 3 * 0.1 as 3 / 10, which is 0.3
    return step < 1 ? count / std::round(1 / step) : count * step;
  };
  double low = std::floor(minimum / step + slack), high = std::ceil(maximum / step - slack);
  if (step < 1e-15) return {low * step, high * step};
  low = times_step(low), high = times_step(high);
  // A side that crosses 0 by less than a step ends sooner: most of its colours would show nothing.
  if (low < 0 && minimum > -step && maximum > 0) low = -rounded_up(-minimum, -low);
  if (high > 0 && maximum < step && minimum < 0) high = rounded_up(maximum, high);
  return {low, high};
}

std::pair<double, double> logarithmic_range(double minimum, double maximum) {
  if (!(maximum > 0) || !std::isfinite(maximum)) return {0.1, 1};
  constexpr double most = 1e6;
  const double high = rounded_up(maximum, std::numeric_limits<double>::max());
  // Rounded down as the inverse is rounded up.
  double low = minimum > high / most ? 1 / rounded_up(1 / minimum, std::numeric_limits<double>::max()) : high / most;
  if (low >= high) low = high / 10;
  return {low, high};
}

bool has_both_signs(double minimum, double maximum) {
  constexpr double overshoot = 0.05;
  return minimum < 0 && minimum < -overshoot * maximum;
}

std::pair<double, double> range_of(const Style& style, const PicturesSpec& looks, double minimum, double maximum) {
  if (looks.log) return logarithmic_range(minimum, maximum);
  const bool has_middle = looks.colour_map.empty() ? style.white_at_zero && has_both_signs(minimum, maximum)
                                                   : find_colour_map(looks.colour_map).map == blue_white_red;
  return has_middle ? symmetric_range(minimum, maximum) : style.range(minimum, maximum);
}

std::pair<double, double> symmetric_range(double minimum, double maximum) {
  const double end = rounded_range(0, std::max(std::fabs(minimum), std::fabs(maximum))).second;
  return {-end, end};
}

}  // namespace gaussdrift::render
