// Inks, places and outlines of a sheet; a sheet as pixels.
#include "render/sheet.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <utility>

#include "render/letters.hpp"

namespace gaussdrift::render {
namespace {

/// Distinct for the colour-blind, too (Okabe and Ito), in the order of the series; and for letters on white, with a
/// contrast of 4.5 at least.
constexpr std::array<Colour, series_inks> palette{
    {{0, 114, 178}, {213, 94, 0}, {0, 158, 115}, {204, 121, 167}, {86, 180, 233}, {230, 159, 0}, {60, 60, 60}}};
constexpr std::array<Colour, series_inks> of_letters{
    {{0, 100, 160}, {166, 70, 0}, {0, 112, 82}, {150, 70, 115}, {20, 105, 155}, {135, 92, 0}, {60, 60, 60}}};

std::size_t series_of(Ink pen) { return static_cast<std::size_t>(pen) - static_cast<std::size_t>(Ink::series_0); }

Colour common_colour(Ink pen) {
  constexpr Colour quiet{105, 105, 105};
  return pen == Ink::text ? ink : pen == Ink::quiet ? quiet : pen == Ink::grid ? pale_grey : grey;
}

std::vector<Polyline> dashes(const std::vector<Point>& way, double length, const Colour& colour) {
  std::vector<Polyline> pieces;
  double walked = 0;
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Point from = way[i - 1], to = way[i];
    const double stretch = std::hypot(to.x - from.x, to.y - from.y);
    for (double s = 0; s < stretch;) {
      const double phase = std::fmod(walked + s, 2 * length);
      const bool ink_here = phase < length;
      const double end = std::min(stretch, s + (ink_here ? length - phase : 2 * length - phase) + 1e-6);
      const auto on = [&](double at) {
        return Point{from.x + (to.x - from.x) * at / stretch, from.y + (to.y - from.y) * at / stretch};
      };
      if (ink_here) pieces.push_back({{on(s), on(end)}, colour});
      s = end;
    }
    walked += stretch;
  }
  return pieces;
}

}  // namespace

Colour colour_of(Ink pen) { return pen < Ink::series_0 ? common_colour(pen) : palette[series_of(pen)]; }

Colour letter_colour(Ink pen) {
  if (pen >= Ink::series_0) return of_letters[series_of(pen)];
  return common_colour(pen == Ink::guide ? Ink::quiet : pen);
}

std::string name_of(Ink pen) {
  constexpr std::array names{"text", "quiet", "grid", "guide"};
  return pen < Ink::series_0 ? names[static_cast<std::size_t>(pen)] : fmt::format("s{}", series_of(pen));
}

Rectangle box_of(const Sheet::Words& words) {
  const double along = letters_width(words.text, words.size), across = line_height * words.size;
  const double width = words.upwards ? across : along, height = words.upwards ? along : across;
  return {words.at.x - 0.5 * static_cast<int>(words.across) * width,
          words.at.y - 0.5 * static_cast<int>(words.along) * height, width, height};
}

Rectangle box_of(const Sheet::Sign& sign) {
  return {sign.at.x - sign.radius, sign.at.y - sign.radius, 2 * sign.radius, 2 * sign.radius};
}

std::vector<Point> corners_of(const Sheet::Sign& sign) {
  constexpr std::array<std::pair<int, double>, 5> shapes{{{16, 0}, {4, 0.125}, {4, 0}, {3, 0.25}, {3, 0.75}}};
  const auto [count, turned] = shapes[sign.shape % shapes.size()];
  std::vector<Point> corners;
  for (int k = 0; k <= count; ++k) {
    const double angle = 2 * M_PI * (double(k) / count + turned);
    corners.push_back({sign.at.x + sign.radius * std::cos(angle), sign.at.y + sign.radius * std::sin(angle)});
  }
  return corners;
}

std::string hexadecimal(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour[0], colour[1], colour[2]);
}

void paint(const Sheet& sheet, Canvas& canvas) {
  for (const Sheet::Stroke& stroke : sheet.strokes)
    canvas.lines(stroke.dash > 0 ? dashes(stroke.points, stroke.dash, colour_of(stroke.ink))
                                 : std::vector<Polyline>{{stroke.points, colour_of(stroke.ink)}},
                 stroke.width);
  for (const Sheet::Sign& sign : sheet.signs) {
    if (sign.filled) canvas.polygon(corners_of(sign), colour_of(sign.ink));
    canvas.lines({{corners_of(sign), colour_of(sign.ink)}}, 0.37 * sign.radius);
  }
  for (const Sheet::Words& words : sheet.words)
    canvas.text(words.at, words.text,
                {.size = words.size,
                 .across = words.across,
                 .along = words.along,
                 .upwards = words.upwards,
                 .colour = letter_colour(words.ink)});
}

}  // namespace gaussdrift::render
