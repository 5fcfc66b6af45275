#include "read/missing_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "base/nan.hpp"
#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

namespace {

using base::nan;

// Fill values of netCDF (9.96921e36), CF files and models (1e20, 1e30, ...), GrADS, Ferret (-1e34), Vis5D (1e35), and
// the largest numbers of the types. No wind and few densities have these sizes, so one of them is enough.
constexpr double largest_single = std::numeric_limits<float>::max(),
                 largest_double = std::numeric_limits<double>::max();
constexpr std::array huge_marks{
    1e19,       1e20, 2e20, 9e20,           9.99e20, 9.999e20, 1e21,          1e25,
    1e30,       1e31, 1e32, 9e33,           1e34,    1e35,     1e36,          9.9692099683868690e36,
    9.96921e36, 1e37, 1e38, largest_single, 1e100,   1e300,    largest_double};
// As large as real numbers may be: they count only where the rest is far smaller.
constexpr std::array modest_marks{999.,   9999.,  99999., 999999., 9999999.,    999.9,       9999.9,     8888.,
                                  88888., 32767., 32768., 65535.,  2147483647., 2147483648., 4294967295.};
constexpr double smallest_huge = 9e18, far_above_rest = 4;

/// The same number, or as a file in single precision has it.
bool is(double value, double mark) {
  return value == mark || (std::abs(mark) <= largest_single && value == double(float(mark)));
}
bool is_either_sign(double value, double mark) { return is(std::abs(value), std::abs(mark)); }

template <class List>
bool among(double value, const List& marks) {
  return std::any_of(marks.begin(), marks.end(), [&](double mark) { return is_either_sign(value, mark); });
}

/// How many values have which binary exponent; index 0 is that of 0.
using Exponents = std::array<std::uint64_t, 2048>;
std::size_t exponent_of(double value) { return (std::bit_cast<std::uint64_t>(value) >> 52) & 0x7ff; }

struct Gap {
  double below, above;  // no size lies between
};
/// Values above are thousands of times those below, and at least a million.
std::optional<Gap> find_gap(const Exponents& exponents) {
  constexpr std::size_t widest = 14;  // binary exponents: a factor of 2^13 at least
  const auto power = [](std::size_t e) { return std::ldexp(1.0, static_cast<int>(e) - 1023); };
  std::size_t above = 0;  // the last exponent that occurred
  for (std::size_t e = exponents.size() - 1; e > 0; --e) {
    if (exponents[e] == 0) continue;
    if (above > 0 && power(above) < 1e6) return std::nullopt;
    if (above >= e + widest) return Gap{power(e + 1), power(above)};
    above = e;
  }
  return std::nullopt;
}

std::string place(const GridData& data, std::size_t point) {
  std::vector<double> x;
  for (int k = 0; k < data.dimension; ++k) {
    x.push_back(data.axis[k][point % data.axis[k].size()]);
    point /= data.axis[k].size();
  }
  if (data.curved) {
    const Vector in_space = data.curved->place({x[0], x[1], x.size() > 2 ? x[2] : 0});
    std::copy_n(in_space.begin(), x.size(), x.begin());
  }
  return fmt::format("({:.6g})", fmt::join(x, ", "));
}

/// Points that are missing get the mean of those neighbours along the axes that have values, layer by layer.
void continue_from_nearest(const GridData& data, std::vector<double>& values) {
  const std::size_t points = data.points(), components = data.components;
  std::vector<std::size_t> open;
  for (std::size_t p = 0; p < points; ++p)
    if (std::isnan(values[p * components])) open.push_back(p);
  std::vector<double> layer;
  while (!open.empty()) {
    std::vector<std::size_t> left, filled;
    layer.clear();
    for (const std::size_t p : open) {
      std::vector<double> sum(components, 0.0);
      int count = 0;
      std::size_t stride = 1;
      for (int k = 0; k < data.dimension; ++k) {
        const std::size_t length = data.axis[k].size(), i = p / stride % length;
        for (const auto& [exists, q] : {std::pair{i > 0, p - stride}, {i + 1 < length, p + stride}}) {
          if (!exists || std::isnan(values[q * components])) continue;
          ++count;
          for (std::size_t c = 0; c < components; ++c) sum[c] += values[q * components + c];
        }
        stride *= length;
      }
      if (count == 0) {
        left.push_back(p);
        continue;
      }
      filled.push_back(p);
      for (const double value : sum) layer.push_back(value / count);
    }
    for (std::size_t f = 0; f < filled.size(); ++f)
      std::copy_n(layer.data() + f * components, components, values.data() + filled[f] * components);
    open = std::move(left);
  }
}

}  // namespace

std::string Marks::reason(double value) const {
  if (std::isnan(value)) return "nan is there";
  if (std::isinf(value)) return fmt::format("{} is there", value);
  for (const double mark : named)
    if (is(value, mark)) return fmt::format("{:.6g} is there, which marks missing data", value);
  for (const double mark : common)
    if (is_either_sign(value, mark)) return fmt::format("{:.6g} is there, a usual mark of missing data", value);
  if (far_out && std::abs(value) >= *far_out)
    return fmt::format("{:.6g} is there, far outside of all other values", value);
  return "";
}

Marks recognise_marks(const GridData& data, std::vector<double> named, bool decays) {
  Marks marks{std::move(named), {}, {}};
  std::vector<double> modest;
  Exponents exponents{};
  double largest = 0;   // of the rest
  bool others = false;  // there is a rest
  const auto add = [](std::vector<double>& list, double mark) {
    if (std::find(list.begin(), list.end(), mark) == list.end()) list.push_back(mark);
  };
  for (const auto& values : data.values)
    for (const double value : values) {
      if (!std::isfinite(value)) continue;
      const double size = std::abs(value);
      const bool real = decays && value > 0 && value < 9999;  // 999 kg/m^3 is the density of water
      if (std::any_of(marks.named.begin(), marks.named.end(), [&](double mark) { return is(value, mark); })) continue;
      if (size >= smallest_huge && among(value, huge_marks)) {
        add(marks.common, size);
      } else if (size >= 999 && size < smallest_huge && !real && among(value, modest_marks)) {
        add(modest, size);
      } else {
        ++exponents[exponent_of(value)];
        largest = std::max(largest, size);
        others = true;
      }
    }
  if (decays && !others) {  // a density of 1e20 everywhere is one
    marks.common.clear();
    return marks;
  }
  if (!decays || !marks.common.empty())
    if (const auto gap = find_gap(exponents)) marks.far_out = gap->above, largest = gap->below;
  for (const double mark : modest)
    if ((largest > 0 || !decays) && mark > far_above_rest * largest) add(marks.common, mark);
  return marks;
}

void settle_missing(GridData& data, const HiddenPoints& hidden, const Marks& marks, Missing missing,
                    const std::vector<std::string>& files) {
  const std::size_t points = data.points(), components = data.components;
  std::size_t count = 0, first_time = 0, first_point = 0;
  std::string first_reason;
  const bool keep = missing == Missing::keep;
  for (std::size_t t = 0; t < data.values.size(); ++t)
    for (std::size_t p = 0; p < points; ++p) {
      double* at = data.values[t].data() + p * components;
      std::string reason;
      if (!keep && !hidden[t].empty() && hidden[t][p]) reason = "the file hides this point";
      for (std::size_t c = 0; c < components && reason.empty(); ++c)
        if (!keep || !std::isfinite(at[c])) reason = marks.reason(at[c]);
      if (reason.empty()) continue;
      if (count++ == 0) first_time = t, first_point = p, first_reason = reason;
      std::fill_n(at, components, nan);
    }
  if (count == 0) return;
  const std::string where = fmt::format("at {}{}", place(data, first_point),
                                        files.size() > 1 ? fmt::format(" in {}", files[first_time]) : "");
  const std::size_t all = points * data.values.size();
  if (missing == Missing::error || keep)
    throw GridFileError(
        fmt::format("{} has no value {}: {} ({} of {} values are missing)", data.name, where, first_reason, count, all),
        keep ? "missing = \"keep\" keeps numbers, and this is none: missing = \"zero\" or \"nearest\""
             : "missing = \"zero\" makes a coast of it, missing = \"nearest\" continues what is beside it, missing = "
               "\"keep\" takes the number as it is; or cut the data to a region that is whole, and say with "
               "\"outside\" what stands around it");
  if (missing == Missing::land) {
    data.land = true;
    data.filled = fmt::format("{} of {} values missing: land", count, all);
    return;
  }
  data.filled = fmt::format("{} of {} values missing, {}", count, all,
                            missing == Missing::zero ? "taken as zero" : "continued from the nearest");
  for (std::size_t t = 0; t < data.values.size(); ++t) {
    auto& values = data.values[t];
    const auto lost = [&](std::size_t p) { return std::isnan(values[p * components]); };
    if (missing == Missing::zero) {
      for (double& value : values)
        if (std::isnan(value)) value = 0;
      continue;
    }
    bool any = false;
    for (std::size_t p = 0; p < points && !any; ++p) any = !lost(p);
    if (!any)
      throw GridFileError(fmt::format("{} has no values at all in {}", data.name, files[t]),
                          "there is nothing that missing = \"nearest\" could continue");
    continue_from_nearest(data, values);
  }
}

}  // namespace gaussdrift::read
