// Round numbers along an axis, and how they are written.
#pragma once

#include <string>
#include <vector>

namespace gaussdrift::render {

/// The power of ten times 1, 2 or 5 next above `length`/`intervals`; length > 0.
double round_step(double length, int intervals);

struct Tick {
  double at;          // true value
  std::string label;  // of (at - offset) / scale
};

/// About `intervals` + 1 round values of [min, max]. Where the numbers would be long ("1000000.25", "2e-10"), labels
/// show (value - offset) / scale, and `title` says so.
struct Ticks {
  std::vector<Tick> list;
  double step = 1;
  double offset = 0;
  double scale = 1;

  /// "x", "x − 1000000", "x / 1e-9", "(x − 5) / 1e-6".
  std::string title(const std::string& name) const;
};

Ticks make_ticks(double min, double max, int intervals);

/// "1000" for 3, "0.01" for -2, "1e-7" as 10 to the -7 beyond three digits.
std::string power_of_ten(int exponent);

/// Shortest form with up to `digits` significant digits, with a true minus sign.
std::string number(double value, int digits);

}  // namespace gaussdrift::render
