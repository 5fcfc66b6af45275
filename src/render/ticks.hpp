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

  /// "x", "x − 1000000", "x / 10⁻⁹", "(x − 5) / 10⁻⁶".
  std::string title(const std::string& name) const;
};

Ticks make_ticks(double min, double max, int intervals);

/// "1000" for 3, "0.01" for -2, "10⁻⁷" for -7: beyond three digits with an exponent.
std::string power_of_ten(int exponent);

/// Powers of ten between 10^min and 10^max, about `intervals` of them at most; 2 and 5 times them, too, where they are
/// few. All are written with exponents if one is. `at` is the logarithm.
std::vector<Tick> logarithmic_ticks(double min, double max, int intervals);

/// "0.024", "2.4·10⁻⁵": for people, with a true minus sign.
std::string told_number(double value, int digits);

/// Shortest form with up to `digits` significant digits, with a true minus sign.
std::string number(double value, int digits);

}  // namespace gaussdrift::render
