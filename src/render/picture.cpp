#include "render/picture.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <tuple>

#include "gaussdrift/error.hpp"
#include "render/drawing_library.hpp"
#include "render/height_field.hpp"
#include "render/on_canvas.hpp"
#include "render/png.hpp"
#include "render/short_memory.hpp"
#include "render/styles.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::render {
namespace {

ColourRange colour_range(const Style& style, const DensityGrid& density, const PictureOptions& options) {
  ColourRange range;
  range.map = options.looks.colour_map.empty() ? style.colours : find_colour_map(options.looks.colour_map).map;
  range.min = options.range_min, range.max = options.range_max, range.log = options.looks.log;
  const bool is_given = std::isfinite(range.min) && std::isfinite(range.max) && range.min < range.max;
  const auto with_middle = [&] {  // such a range was chosen for values of both signs
    if (options.looks.colour_map.empty() && style.white_at_zero && !range.log && range.min == -range.max)
      range.map = blue_white_red;
    return range;
  };
  if (is_given && (!range.log || range.min > 0)) return with_middle();
  double minimum = 0, maximum = 0;
  if (range.log) {
    const ValueFacts facts = facts_of(density.rho);
    minimum = facts.minimum, maximum = facts.maximum;
  }
  for (const double value : density.rho)
    if (!range.log && std::isfinite(value)) minimum = std::min(minimum, value), maximum = std::max(maximum, value);
  std::tie(range.min, range.max) = range_of(style, options.looks, minimum, maximum);
  return with_middle();
}

/// The first point to show along an axis, and how many: all that lie in [low, high] and one beyond each end.
std::pair<std::size_t, std::size_t> points_between(const Lattice& lattice, int axis, double low, double high) {
  const auto k = static_cast<std::size_t>(axis);
  const double from = (low - lattice.origin[axis]) / lattice.spacing,
               to = (high - lattice.origin[axis]) / lattice.spacing;
  const auto last = static_cast<double>(lattice.points[k] - 1);
  const auto first = static_cast<std::size_t>(std::clamp(std::floor(from + 1e-9), 0., last));
  const auto end = static_cast<std::size_t>(std::clamp(std::ceil(to - 1e-9), static_cast<double>(first), last));
  return {first, end - first + 1};
}

/// A part of the density with its fields.
DensityGrid cut_out(const DensityGrid& density, const std::vector<double>& zoom) {
  const Lattice& full = density.lattice;
  DensityGrid part{full, {}};
  std::array<std::size_t, 3> first{};
  for (int axis = 0; axis < full.dimension; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    std::tie(first[k], part.lattice.points[k]) = points_between(full, axis, zoom[2 * k], zoom[2 * k + 1]);
    part.lattice.origin[axis] = full.coordinate(axis, first[k]);
  }
  const auto copied = [&](const std::vector<double>& values, std::size_t components) {
    std::vector<double> some;
    some.reserve(part.lattice.size() * components);
    for (std::size_t k = 0; k < part.lattice.points[2]; ++k)
      for (std::size_t j = 0; j < part.lattice.points[1]; ++j) {
        const std::size_t row = first[0] + full.points[0] * (first[1] + j + full.points[1] * (first[2] + k));
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(row * components);
        some.insert(some.end(), begin, begin + static_cast<std::ptrdiff_t>(part.lattice.points[0] * components));
      }
    return some;
  };
  part.rho = copied(density.rho, 1);
  for (const FieldOnGrid& field : density.fields)
    part.fields.push_back(
        {field.name, field.components, copied(field.values, static_cast<std::size_t>(field.components))});
  return part;
}

}  // namespace

std::string unavailable_reason() { return missing_drawing(); }

std::string drawing_library() { return drawing().library(); }

void check_available() {
  if (const std::string reason = unavailable_reason(); !reason.empty()) throw CommandLineError(reason);
}

Image painted(int width, int height, const Background& background, const std::function<void(Canvas&)>& paint) {
  check_available();
  if (width < 64 || height < 48 || width > 16384 || height > 16384)
    throw Error(ExitCode::internal, fmt::format("a picture of {} x {} pixels is not possible", width, height));
  const WhileDrawing guard;
  Canvas canvas(width, height, background.transparent, background.type);
  paint(canvas);
  return canvas.picture();
}

void on_canvas(int width, int height, const std::filesystem::path& png, const std::function<void(Canvas&)>& paint) {
  write::write_text(png, png_of(painted(width, height, {}, paint)));
}

Image picture_of(const Style& style, const DensityGrid& density, const PictureOptions& wanted) {
  PictureOptions options = wanted;
  if (density.lattice.sphere > 0) options.axes = {"longitude (degrees)", "latitude (degrees)"};
  const PicturesSpec& looks = options.looks;
  const Background background{looks.transparent, looks.large_type ? large_type : 1};
  const bool part = looks.zoom.size() == 2 * static_cast<std::size_t>(density.lattice.dimension);
  const DensityGrid cut = part ? cut_out(density, looks.zoom) : DensityGrid{};
  const DensityGrid& shown = part ? cut : density;
  const ColourRange range = colour_range(style, shown, options);
  return painted(options.width, options.height, background, style.painting(shown, range, options));
}

void show_field(DensityGrid& density, std::string_view name) {
  if (name.empty()) return;
  const auto field = std::find_if(density.fields.begin(), density.fields.end(),
                                  [&](const FieldOnGrid& one) { return one.name == name; });
  if (field == density.fields.end())
    throw Error(ExitCode::internal, fmt::format("the {} is not there to be drawn", name));
  const auto components = static_cast<std::size_t>(field->components);
  for (std::size_t i = 0; i < density.rho.size(); ++i) {
    const double* value = &field->values[components * i];
    double squares = 0;
    for (std::size_t k = 0; k < components; ++k) squares += value[k] * value[k];
    density.rho[i] = components == 1 ? *value : std::sqrt(squares);
  }
}

void draw(const Style& style, const DensityGrid& density, const PictureOptions& options,
          const std::filesystem::path& png) {
  write::write_text(png, png_of(picture_of(style, density, options)));
}

}  // namespace gaussdrift::render
