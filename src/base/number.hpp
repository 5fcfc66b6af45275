// Numbers in text, read whole or not at all, and numbers in messages, with the digits that tell them apart.
#pragma once

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>
#include <string>
#include <string_view>

namespace gaussdrift::base {

/// The text without blanks and line ends around it.
inline std::string_view without_blanks(std::string_view text) {
  constexpr std::string_view blanks = " \t\r\n\f\v";
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

/// The number that the whole text is: "1.5", "+1", " 2e-3 "; nothing for "1,5", "1.5 m", "", "1.5" as a whole number,
/// and numbers that the type cannot hold. Of floating-point types "nan" and "inf" are numbers too.
template <class Number>
requires std::integral<Number> || std::floating_point<Number> std::optional<Number> read_number(std::string_view text) {
  text = without_blanks(text);
  if (text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+') text.remove_prefix(1);
  Number number{};
  const char* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, number);
  return error == std::errc() && rest == end && !text.empty() ? std::optional(number) : std::nullopt;
}

/// "1.5e+00" of "1.5D+00", as Fortran writes exponents; empty if it is no such number.
inline std::string with_e(std::string_view number) {
  const std::size_t d = number.find_first_of("dD");
  if (d == std::string_view::npos || number.find_first_not_of("0123456789.+-", 0) != d) return "";
  std::string text(number);
  text[d] = 'e';
  return text;
}

/// The number with six digits, or as many more as show that it is none of the others: 0.7 beside 0.69999999 is "0.7",
/// that is "0.69999999".
template <class... Others>
std::string told_apart(double number, Others... others) {
  std::string text;
  for (int digits = 6; digits <= 17; ++digits) {
    text = fmt::format("{:.{}g}", number, digits);
    if (((number == others || text != fmt::format("{:.{}g}", double(others), digits)) && ...)) break;
  }
  return text;
}

/// x > 0 with few digits, rounded down, so that a printed limit keeps to the limit. Rounding of up to 1e-12 is undone.
inline double rounded_down(double x, int digits) {
  if (!(x > 0) || !std::isfinite(x)) return x;
  const double unit = std::pow(10, std::floor(std::log10(x)) - (digits - 1));
  return *read_number<double>(fmt::format("{:.{}e}", std::floor(x / unit * (1 + 1e-12)) * unit, digits - 1));
}

/// The same, never downwards.
inline double rounded_up(double x, int digits) {
  if (!(x > 0) || !std::isfinite(x)) return x;
  const double unit = std::pow(10, std::floor(std::log10(x)) - (digits - 1));
  return *read_number<double>(fmt::format("{:.{}e}", std::ceil(x / unit * (1 - 1e-12)) * unit, digits - 1));
}

}  // namespace gaussdrift::base
