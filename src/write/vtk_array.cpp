#include "write/vtk_array.hpp"

#include <fmt/format.h>

#include <bit>
#include <charconv>

#include "base/seam.hpp"

namespace gaussdrift::write {

static_assert(std::endian::native == std::endian::little, "files say that they are little-endian");

/// As scripts of web pages lay numbers out, which VTK does as well: an exponent from 1e21 on and below 1e-6.
std::string shortest_text(double value) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value < 0 ? "-Infinity" : "Infinity";
  if (value == 0) return "0";
  std::array<char, 32> written;
  const auto end =
      std::to_chars(written.data(), written.data() + written.size(), std::abs(value), std::chars_format::scientific)
          .ptr;
  const std::string_view text(written.data(), static_cast<std::size_t>(end - written.data()));
  const std::size_t e = text.find('e');
  int exponent = 0;
  std::from_chars(text.data() + e + (text[e + 1] == '+' ? 2 : 1), end, exponent);
  std::string digits(text.substr(0, e));
  std::erase(digits, '.');
  const char* sign = value < 0 ? "-" : "";
  const auto with_point = [&](std::size_t whole) {
    const std::string_view all = digits;
    return fmt::format("{}{}{}{}", sign, all.substr(0, whole), all.size() > whole ? "." : "", all.substr(whole));
  };
  if (exponent < -6 || exponent >= 21) return fmt::format("{}e{:+}", with_point(1), exponent);
  if (exponent < 0) return fmt::format("{}0.{:0>{}}{}", sign, "", -exponent - 1, digits);
  const std::size_t whole = static_cast<std::size_t>(exponent) + 1;
  if (digits.size() < whole) digits.resize(whole, '0');
  return with_point(whole);
}

void Base64Numbers::encode() {
  base::seam();
  constexpr const char* letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::array<char, 32 * 1024> encoded;
  char* to = encoded.data();
  std::fill(block_.begin() + static_cast<std::ptrdiff_t>(used_),
            block_.begin() + static_cast<std::ptrdiff_t>((used_ + 2) / 3 * 3), static_cast<unsigned char>(0));
  for (std::size_t i = 0; i < used_; i += 3) {
    const unsigned group = unsigned{block_[i]} << 16 | unsigned{block_[i + 1]} << 8 | unsigned{block_[i + 2]};
    for (const unsigned shift : {18u, 12u, 6u, 0u}) *to++ = letters[group >> shift & 63u];
  }
  for (std::size_t missing = (3 - used_ % 3) % 3; missing > 0; --missing)
    to[-static_cast<std::ptrdiff_t>(missing)] = '=';
  text_.append(encoded.data(), static_cast<std::size_t>(to - encoded.data()));
  used_ = 0;
}

void begin_array(std::string& text, const ArrayHeading& heading, std::string_view type, const ValueRange& range) {
  text += fmt::format(
      "{0:{1}}<DataArray type=\"{2}\" Name=\"{3}\"{4} format=\"binary\" RangeMin=\"{5}\" RangeMax=\"{6}\">\n{0:{1}}  ",
      "", heading.indent, type, heading.name, heading.attributes, shortest_text(range.least),
      shortest_text(range.most));
}

void end_array(std::string& text, const ArrayHeading& heading, const ValueRange* norms) {
  text += '\n';
  if (norms)
    text += fmt::format(
        "{0:{1}}  <InformationKey name=\"L2_NORM_RANGE\" location=\"vtkDataArray\" length=\"2\">\n"
        "{0:{1}}    <Value index=\"0\">\n{0:{1}}      {2:.11g}\n{0:{1}}    </Value>\n"
        "{0:{1}}    <Value index=\"1\">\n{0:{1}}      {3:.11g}\n{0:{1}}    </Value>\n"
        "{0:{1}}  </InformationKey>\n",
        "", heading.indent, norms->least, norms->most);
  text += fmt::format("{:{}}</DataArray>\n", "", heading.indent);
}

}  // namespace gaussdrift::write
