#include "cli/looks.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <vector>

#include "base/suggest.hpp"
#include "gaussdrift/error.hpp"
#include "render/colour.hpp"
#include "render/styles.hpp"

namespace gaussdrift::cli {

namespace {

template <class Thing>
std::vector<std::string> names(const std::vector<Thing>& things) {
  std::vector<std::string> list;
  for (const Thing& thing : things) list.emplace_back(thing.about.name);
  return list;
}

/// Numbers between single letters of `separators`; nothing where the text is something else.
std::optional<std::vector<double>> numbers(const std::string& text, const std::string& separators) {
  std::vector<double> list;
  const char *at = text.data(), *end = at + text.size();
  while (true) {
    double number = 0;
    const auto [next, problem] = std::from_chars(at, end, number);
    if (problem != std::errc{} || !std::isfinite(number)) return std::nullopt;
    list.push_back(number);
    if (next == end) return list;
    if (separators.find(*next) == separators.npos) return std::nullopt;
    at = next + 1;
  }
}

std::vector<double> numbers_of(const std::string& option, const std::string& text, const std::string& separators,
                               std::size_t count, const char* example) {
  const auto list = numbers(text, separators);
  if (!list || (count > 0 && list->size() != count))
    throw CommandLineError(fmt::format("{} {}: give it as {}", option, text, example));
  return *list;
}

}  // namespace

void check_name(const std::string& option, const std::string& name, const std::vector<std::string>& known) {
  if (std::find(known.begin(), known.end(), name) != known.end()) return;
  const auto near = base::suggest(name, known);
  throw CommandLineError(fmt::format("{} {} is not known{} there are {}", option, name,
                                     near ? fmt::format("; did you mean {}?", *near) : ";", fmt::join(known, ", ")));
}

std::array<int, 2> size_of(const std::string& option, const std::string& text) {
  const auto list = numbers_of(option, text, "x", 2, "1280x960");
  for (const double side : list)
    if (side != std::floor(side) || side < 64 || side > 16384)
      throw CommandLineError(fmt::format("{} {}: sides are whole numbers of pixels from 64 to 16384", option, text));
  return {static_cast<int>(list[0]), static_cast<int>(list[1])};
}

void declare_looks(OptionList& options, LookOptions& given) {
  options.add("--range", given.range, "A:B", "lower and upper end of the colours, as 0:1");
  options.flag("--log", given.log, "colours, heights and lines by the logarithm");
  options.flag("--per-frame", given.per_frame, "a range of its own for each picture");
  options.add("--size", given.size, "WxH", "width and height in pixels; 1280x960 by default");
  options
      .add("--colour-map", given.colour_map, "NAME", fmt::format("{}", fmt::join(names(render::colour_maps()), ", ")))
      .offers([] { return names(render::colour_maps()); });
  options.add("--view", given.view, "A,E",
              "azimuth and elevation of the eye in degrees, for pictures in perspective; -62,31 by default");
  options.add("--zoom", given.zoom, "A:B,C:D", "a part of the domain: x from A to B, y from C to D, in space z too");
  options
      .add("--velocity", given.velocity, "HOW",
           fmt::format("the velocity over maps in 2D: {}", fmt::join(names(render::velocity_styles()), ", ")))
      .offers([] { return names(render::velocity_styles()); });
  options.flag("--transparent", given.transparent, "no background");
  options.flag("--large-type", given.large_type, "letters, lines and margins half as large again, for slides");
}

PicturesSpec looks_of(const LookOptions& given) {
  PicturesSpec looks;
  looks.log = given.log, looks.per_frame = given.per_frame;
  looks.transparent = given.transparent, looks.large_type = given.large_type;
  looks.colour_map = given.colour_map, looks.velocity = given.velocity;
  if (!given.colour_map.empty()) check_name("--colour-map", given.colour_map, names(render::colour_maps()));
  if (!given.velocity.empty()) check_name("--velocity", given.velocity, names(render::velocity_styles()));
  if (!given.size.empty()) looks.size = size_of("--size", given.size);
  if (!given.range.empty()) {
    const auto ends = numbers_of("--range", given.range, ":", 2, "0:1");
    if (!(ends[0] < ends[1]))
      throw CommandLineError(fmt::format("--range {}: the first end is the lower one", given.range));
    if (given.log && ends[0] <= 0)
      throw CommandLineError(fmt::format("--range {}: a logarithm needs numbers above 0", given.range));
    if (given.per_frame) throw CommandLineError("--range is one range for all pictures, and --per-frame wants many");
    looks.range = {ends[0], ends[1]};
  }
  if (!given.view.empty()) {
    const auto angles = numbers_of("--view", given.view, ",", 2, "-62,31");
    if (angles[1] < 5 || angles[1] > 85)
      throw CommandLineError(fmt::format("--view {}: the elevation lies between 5 and 85 degrees", given.view));
    looks.view = {angles[0], angles[1]};
  }
  if (!given.zoom.empty()) {
    looks.zoom = numbers_of("--zoom", given.zoom, ":,", 0, "0:1,0.5:1");
    const std::size_t count = looks.zoom.size();
    bool ascends = count == 4 || count == 6;
    for (std::size_t k = 0; ascends && k < count; k += 2) ascends = looks.zoom[k] < looks.zoom[k + 1];
    if (!ascends)
      throw CommandLineError(
          fmt::format("--zoom {}: give the lower and the upper end along each axis, as 0:1,0.5:1, in space three times",
                      given.zoom));
  }
  return looks;
}

}  // namespace gaussdrift::cli
