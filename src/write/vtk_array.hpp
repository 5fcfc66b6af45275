// One array of a ParaView file: inline, in base64, behind its length, with the range of its values. It has the letters of
// VTK's own writer (9.1), which is not called: it crashes where memory runs out (docs/reliability.md).
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace gaussdrift::write {

/// The shortest text that gives the same double: "0.1", "2.5e-9", "1e+300", "NaN", "-Infinity".
std::string shortest_text(double value);

/// Least and largest value, not of NaN; of none VTK's.
struct ValueRange {
  double least = 1e299, most = -1e299;
  void add(double value) {
    if (value < least) least = value;
    if (value > most) most = value;
  }
};

/// Numbers that are put one after another, as base64 behind their length in bytes.
class Base64Numbers {
 public:
  Base64Numbers(std::string& text, std::uint64_t count) : text_(text) { put(8 * count); }
  template <class Number>
  void put(Number number) {
    static_assert(sizeof(Number) == 8 && std::is_arithmetic_v<Number>);
    std::memcpy(block_.data() + used_, &number, 8);
    used_ += 8;
    if (used_ == block_.size()) encode();
  }
  void end() { encode(); }

 private:
  /// A seam (base/seam.hpp).
  void encode();

  std::string& text_;
  std::array<unsigned char, 24 * 1024> block_;  // groups of three bytes, and numbers of eight
  std::size_t used_ = 0;
};

/// How an array is called and how far it is indented. `attributes` stand between its name and its format.
struct ArrayHeading {
  std::size_t indent = 0;
  std::string_view name, attributes = {};
};

void begin_array(std::string& text, const ArrayHeading& heading, std::string_view type, const ValueRange& range);
/// `norms`: of an array of vectors, their range.
void end_array(std::string& text, const ArrayHeading& heading, const ValueRange* norms);

/// `count` numbers; at(i) is a double or an std::int64_t.
template <class At>
void add_array(std::string& text, const ArrayHeading& heading, std::size_t count, const At& at) {
  using Number = std::decay_t<decltype(at(std::size_t{0}))>;
  ValueRange range;
  for (std::size_t i = 0; i < count; ++i) range.add(static_cast<double>(at(i)));
  begin_array(text, heading, std::is_same_v<Number, double> ? "Float64" : "Int64", range);
  Base64Numbers numbers(text, count);
  for (std::size_t i = 0; i < count; ++i) numbers.put(at(i));
  numbers.end();
  end_array(text, heading, nullptr);
}

/// `count` vectors or matrices; at(j) is an std::array<double, 3> or <double, 9>. The range is that of their lengths.
template <class At>
void add_vectors(std::string& text, ArrayHeading heading, std::size_t count, const At& at) {
  constexpr std::size_t components = std::tuple_size_v<std::decay_t<decltype(at(std::size_t{0}))>>;
  static_assert(components == 3 || components == 9);
  heading.attributes = components == 3 ? " NumberOfComponents=\"3\"" : " NumberOfComponents=\"9\"";
  ValueRange range;
  for (std::size_t j = 0; j < count; ++j) {
    double square = 0;
    for (const double component : at(j)) square += component * component;
    range.add(square);
  }
  if (count > 0) range = {std::sqrt(range.least), std::sqrt(range.most)};
  begin_array(text, heading, "Float64", range);
  Base64Numbers numbers(text, components * count);
  for (std::size_t j = 0; j < count; ++j)
    for (const double component : at(j)) numbers.put(component);
  numbers.end();
  end_array(text, heading, &range);
}

}  // namespace gaussdrift::write
