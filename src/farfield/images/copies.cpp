#include "farfield/images/copies.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "farfield/check.hpp"

namespace farfield::detail {
namespace {

constexpr int most_near = 16;              // copies to a side: more cost more than they are worth
constexpr std::size_t most_copies = 2000;  // in all
/// What a blob's core may change in the field of the rest, as a part of the tolerance.
constexpr double core_part = 0.01;

std::string axis_name(int l) { return "Options::axes[" + std::to_string(l) + "]"; }

/// x - low as a number in [0, period).
double within(double distance, double period) {
  const double rest = distance - period * std::floor(distance / period);
  return rest >= 0 && rest < period ? rest : 0;
}

/// Copies that must be sources beside the longest reach of the box.
int near_copies(const CopiedAxis& axis, double distance, double core_reach) {
  return static_cast<int>(std::min(
      1e6, std::max({1.0, std::ceil(distance / axis.length * (1 - 1e-12)), std::ceil(core_reach / axis.length)})));
}

/// Adds to every copy those along axis l.
void along(int l, const std::vector<Copy>& of_axis, std::vector<Copy>& copies) {
  std::vector<Copy> all;
  for (const Copy& one : of_axis)
    for (Copy copy : copies) {
      copy.shift[static_cast<std::size_t>(l)] = one.shift[0];
      copy.sign[static_cast<std::size_t>(l)] = one.sign[0];
      copy.charge *= one.charge;
      all.push_back(copy);
    }
  copies = std::move(all);
}

Copy one_copy(double shift, double sign, double mirrored_charge) {
  return {.shift = {shift, 0, 0}, .sign = {sign, 1, 1}, .charge = sign < 0 ? mirrored_charge : 1};
}

}  // namespace

bool has_copies(const Options& options) {
  return std::any_of(options.axes.begin(), options.axes.end(),
                     [](const Axis& axis) { return axis.ends != Ends::unbounded; });
}

void check_axes(const Options& options, int dimension) {
  if (!has_copies(options)) return;
  const auto refuse = [](const std::string& what) { throw InvalidArgument("farfield: " + what); };
  if (dimension == 1) refuse("Options::axes are for 2 and 3 dimensions");
  int repeated = 0;
  for (int l = 0; l < 3; ++l) {
    const Axis& axis = options.axes[static_cast<std::size_t>(l)];
    if (axis.ends == Ends::unbounded) continue;
    if (l >= dimension) refuse(axis_name(l) + " must be unbounded in " + std::to_string(dimension) + " dimensions");
    const bool both = axis.ends == Ends::periodic || axis.ends == Ends::mirrors;
    const double length = axis.high - axis.low;
    if (both && !(length > 0 && std::isfinite(length)))
      refuse(axis_name(l) + " reaches from " + text(axis.low) + " to " + text(axis.high) +
             ", must have a positive and finite length");
    if (!std::isfinite(axis.ends == Ends::mirror_high ? axis.high : axis.low))
      refuse(axis_name(l) + " has a mirror at a place that is not finite");
    repeated += both;
  }
  if (dimension == 3 && repeated != 0 && repeated != 3)
    refuse(
        "in 3 dimensions either all of Options::axes must be periodic or have mirrors at both ends, or none of them; "
        "found " +
        std::to_string(repeated));
  if (repeated != 0 && options.tolerance < smallest_folded_tolerance)
    throw ToleranceError("farfield: Options::tolerance = " + text(options.tolerance) +
                         " cannot be promised where Options::axes are periodic or between mirrors, must be at least " +
                         text(smallest_folded_tolerance));
}

InBox in_box(const Axis& axis, double x) {
  const double length = axis.high - axis.low;
  switch (axis.ends) {
    case Ends::unbounded:
      return {x, 1};
    case Ends::periodic:
      return {x >= axis.low && x <= axis.high ? x : axis.low + within(x - axis.low, length), 1};
    case Ends::mirrors: {
      if (x >= axis.low && x <= axis.high) return {x, 1};
      const double along = within(x - axis.low, 2 * length);
      return along <= length ? InBox{axis.low + along, 1} : InBox{std::max(axis.low, axis.high - (along - length)), -1};
    }
    case Ends::mirror_low:
      return x < axis.low ? InBox{axis.low + (axis.low - x), -1} : InBox{x, 1};
    case Ends::mirror_high:
      return x > axis.high ? InBox{axis.high - (x - axis.high), -1} : InBox{x, 1};
  }
  return {x, 1};
}

template <int d>
Copies<d>::Copies(const Options& options, const double* low, const double* high, double distance) {
  double longest = 0, period = 0;
  for (std::size_t l = 0; l < d; ++l) {
    const Axis& axis = options.axes[l];
    CopiedAxis& copied = axes_[l];
    copied.ends = axis.ends;
    if (!copied.repeats()) continue;
    copied.length = axis.high - axis.low;
    copied.centre = axis.low + copied.length / 2;
    period = std::max(period, copied.length);
  }
  for (std::size_t l = 0; l < d; ++l) {
    CopiedAxis& copied = axes_[l];
    if (!copied.repeats()) {
      const bool mirror = copied.mirrors();
      copied.centre = !mirror ? low[l] + (high[l] - low[l]) / 2
                              : (copied.ends == Ends::mirror_low ? options.axes[l].low : options.axes[l].high);
      // A quarter of a power of 2 more or less: then points that move keep their rest for many steps.
      const double extent =
          std::max(mirror ? std::max(high[l] - copied.centre, copied.centre - low[l]) : high[l] - low[l], period / 4);
      copied.length = period > 0 ? period * std::exp2(std::ceil(4 * std::log2(extent / period)) / 4) : extent;
    }
    longest = std::max(longest, copied.reach());
  }

  const double core = options.core_radius * std::sqrt(std::log(1 / (core_part * options.tolerance)));
  const double mirrored = options.mirror_images == MirrorImages::opposite ? -1 : 1;
  near_ = turned_ = {Copy{}};
  for (int l = 0; l < d; ++l) {
    CopiedAxis& axis = axes_[static_cast<std::size_t>(l)];
    std::vector<Copy> of_axis{one_copy(0, 1, mirrored)}, turned = of_axis;
    if (axis.repeats()) {
      axis.near = near_copies(axis, distance * longest, core);
      if (axis.near > most_near)
        throw InvalidArgument("farfield: " + axis_name(l) + " has the length " + text(axis.length) +
                              ", must be at least " + text(std::max(distance * longest, core) / most_near) +
                              " beside points that lie up to " + text(longest) + " apart along another axis" +
                              (core > 0 ? " and blobs of core radius " + text(options.core_radius) : ""));
      for (int m = 1; m <= axis.near; ++m)
        for (const int k : {-m, m})
          of_axis.push_back(one_copy(k * axis.length, axis.ends == Ends::mirrors && m % 2 == 1 ? -1 : 1, mirrored));
    } else if (axis.mirrors()) {
      of_axis.push_back(one_copy(0, -1, mirrored));
    }
    if (axis.mirrors()) turned.push_back(one_copy(0, -1, mirrored));
    along(l, of_axis, near_);
    along(l, turned, turned_);
  }
  if (near_.size() > most_copies)
    throw InvalidArgument("farfield: the lengths of Options::axes are so different that " +
                          std::to_string(near_.size()) + " copies of the points would be summed, at most " +
                          std::to_string(most_copies) + " are; make the box less flat");
}

template class Copies<2>;
template class Copies<3>;

}  // namespace farfield::detail

namespace farfield {

template <int d>
std::size_t near_copies(const Options& options) {
  detail::check_axes(options, d);
  double longest = 0, low[3] = {}, high[3] = {};
  for (const Axis& axis : options.axes) longest = std::max(longest, axis.high - axis.low);
  for (std::size_t l = 0; l < d; ++l) {
    const Axis& axis = options.axes[l];
    low[l] = axis.ends == Ends::mirror_high ? axis.high : axis.low;
    high[l] = low[l] + longest;
  }
  return detail::Copies<d>(options, low, high, detail::good_distance).near().size();
}

template std::size_t near_copies<2>(const Options& options);
template std::size_t near_copies<3>(const Options& options);

}  // namespace farfield
