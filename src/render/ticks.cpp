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

/// Powers of ten that are written without an exponent.
bool is_plain(int exponent) { return exponent >= -2 && exponent <= 3; }

std::string with_exponent(int exponent) {
  static const std::array<const char*, 10> raised{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += raised[static_cast<std::size_t>(digit - '0')];
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
  return is_plain(exponent) ? number(std::pow(10., exponent), 5) : with_exponent(exponent);
}

std::vector<Tick> logarithmic_ticks(double min, double max, int intervals) {
  const double low = min - 1e-9, high = max + 1e-9;
  const int first = static_cast<int>(std::ceil(low)), last = static_cast<int>(std::floor(high));
  const int lowest = last - first >= 2 ? first : static_cast<int>(std::floor(low + 2e-9));
  const bool plain = is_plain(lowest) && is_plain(last);
  const auto text = [plain](int factor, int exponent) {
    if (plain) return number(factor * std::pow(10., exponent), 5);
    const std::string power = exponent == 0 ? "1" : exponent == 1 ? "10" : with_exponent(exponent);
    return factor == 1 ? power : exponent == 0 ? std::to_string(factor) : fmt::format("{}·{}", factor, power);
  };
  std::vector<Tick> ticks;
  if (last - first >= 2) {
    const int every = std::max(1, static_cast<int>(std::ceil((high - low) / intervals)));
    for (int k = first; k <= last; ++k)
      if (k % every == 0) ticks.push_back({double(k), text(1, k)});
    return ticks;
  }
  for (int k = first - 1; k <= last; ++k)
    for (const int factor : {1, 2, 5})
      if (const double at = k + std::log10(factor); at >= low && at <= high) ticks.push_back({at, text(factor, k)});
  if (ticks.size() >= 2) return ticks;
  ticks.clear();  // less than a third of a decade: round numbers
  for (const Tick& tick : make_ticks(std::pow(10., min), std::pow(10., max), intervals).list)
    if (tick.at > 0) ticks.push_back({std::log10(tick.at), told_number(tick.at, 4)});
  return ticks;
}

std::string told_number(double value, int digits) {
  if (value == 0 || !std::isfinite(value)) return number(value, digits);
  const std::string scientific = fmt::format("{:.{}e}", value, digits - 1);
  const std::size_t e = scientific.find('e');
  const int exponent = std::stoi(scientific.substr(e + 1));
  if (exponent >= -3 && exponent <= 3) return number(value, std::max(digits, exponent + 1));
  const std::string factor = number(std::stod(scientific.substr(0, e)), digits);
  if (factor == "1") return with_exponent(exponent);
  return fmt::format("{}·{}", factor, with_exponent(exponent));
}

std::string Ticks::title(const std::string& name) const {
  std::string text = name;
  if (offset != 0)
    text += fmt::format(" {} {}", offset > 0 ? "\u2212" : "+", tidy(fmt::format("{:.15g}", std::fabs(offset))));
  if (scale == 1) return text;
  return fmt::format(fmt::runtime(offset != 0 ? "({}) / {}" : "{} / {}"), text,
                     with_exponent(static_cast<int>(std::lround(std::log10(scale)))));
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
