#include "render/ticks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <string>

namespace gaussdrift::render {
namespace {

/// "1.5e-07" as "1.5e-7", "2e+09" as "2e9", and a true minus sign.
std::string tidy(std::string text) {
  if (const std::size_t e = text.find('e'); e != std::string::npos) {
    const std::size_t first = text.find_first_not_of("+-0", e + 1);
    text = text.substr(0, e + 1) + (text[e + 1] == '-' ? "-" : "") +
           (first == std::string::npos ? "0" : text.substr(first));
  }
  for (std::size_t i = 0; (i = text.find('-', i)) != std::string::npos; i += 3) text.replace(i, 1, "\u2212");
  return text;
}

}  // namespace

double round_step(double length, int intervals) {
  const double rough = length / intervals;
  const double power = std::pow(10., std::floor(std::log10(rough)));
  for (const double factor : {1., 2., 5.})
    if (factor * power >= rough * (1 - 1e-9)) return factor * power;
  return 10 * power;
}

std::string number(double value, int digits) { return tidy(fmt::format("{:.{}g}", value, digits)); }

std::string power_of_ten(int exponent) {
  if (exponent >= -2 && exponent <= 3) return number(std::pow(10., exponent), 5);
  static const std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += raised[static_cast<std::size_t>(digit - '0')];
  return text;
}

std::string Ticks::title(const std::string& name) const {
  std::string text = name;
  if (offset != 0)
    text += fmt::format(" {} {}", offset > 0 ? "\u2212" : "+", tidy(fmt::format("{:.15g}", std::fabs(offset))));
  if (scale == 1) return text;
  return fmt::format(fmt::runtime(offset != 0 ? "({}) / {}" : "{} / {}"), text, tidy(fmt::format("{:g}", scale)));
}

Ticks make_ticks(double min, double max, int intervals) {
  Ticks ticks;
  const double length = max - min;
  if (!(length > 0) || !std::isfinite(length)) return ticks;
  ticks.step = round_step(length, intervals);
  const double largest = std::max(std::fabs(min), std::fabs(max));
  // Where ticks differ only after more than 5 digits, a round offset is taken off.
  if (largest > 1e5 * ticks.step) {
    const double round = 10 * round_step(length, 1);
    ticks.offset = std::round(0.5 * (min + max) / round) * round;
    if (ticks.offset > min) ticks.offset = std::floor(min / ticks.step + 1e-6) * ticks.step;
  }
  const double shown = std::max(std::fabs(min - ticks.offset), std::fabs(max - ticks.offset));
  if (shown >= 1e5 || shown < 1e-2) ticks.scale = std::pow(10., std::floor(std::log10(shown * (1 + 1e-9))));

  const double step = ticks.step / ticks.scale;
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  // Ticks are counted from the offset, which is nearly a multiple of the step. So integers stay small.
  const double first = std::ceil((min - ticks.offset) / ticks.step - 1e-6);
  const double last = std::floor((max - ticks.offset) / ticks.step + 1e-6);
  for (double i = first; i <= last && ticks.list.size() < 100; ++i) {
    const double at = ticks.offset + i * ticks.step;
    ticks.list.push_back({at, tidy(fmt::format("{:.{}f}", i * step + 0., decimals))});
  }
  return ticks;
}

}  // namespace gaussdrift::render
