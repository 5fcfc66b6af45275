// An array of numbers as a page holds it: rounded to 65535 levels between its smallest and its largest value, each level
// as its difference from what the two before it lead to expect, and these deflated.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace gaussdrift::report {

/// A level L > 0 stands for (1 - s) min + s max with s = (L - 1)/65534, so that a value is wrong by (max - min)/131068 at
/// most; 0 for what is no number. With r = L - p modulo 65536, where p = 2 L[i-1] - L[i-2] on a line of the first axis,
/// L[i-1] at its second point and the first of the line before at its first, the bytes are deflated from the low bytes of
/// all zigzag(r), and their high bytes behind them; zigzag(0, -1, 1, -2, ...) = 0, 1, 2, 3, ...
struct Stream {
  std::string name;
  std::uint32_t every = 0;  // on the grid of the run, every how many points of each axis; 0: not on its grid
  std::array<std::uint32_t, 3> shape{1, 1, 1};  // first axis fastest
  double min = 0, max = 0;
  std::string bytes;

  std::size_t size() const { return std::size_t{shape[0]} * shape[1] * shape[2]; }
};

constexpr double levels_between_ends = 65534;

/// What is not finite becomes 0. `values` fill the shape.
Stream stream_of(std::string name, std::uint32_t every, std::array<std::uint32_t, 3> shape,
                 const std::vector<double>& values);

/// Throws FileError where the bytes are not those of so many levels.
std::vector<std::uint16_t> levels_of(const Stream& stream);

/// NaN for what is no number. Throws FileError as levels_of().
std::vector<double> values_of(const Stream& stream);

/// Every second point on each axis, with the same levels. Throws FileError as levels_of().
Stream coarser(const Stream& stream);

}  // namespace gaussdrift::report
