// A drawing of lines, signs and words without pixels: what a chart is before it becomes a PNG, an SVG or a PDF. Places
// are in pixels from the lower left. Lines are below the signs, these below the words.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "render/canvas.hpp"

namespace gaussdrift::render {

/// What something is drawn with. A page may give each of them other colours: their names are classes of the SVG.
enum class Ink { text, quiet, grid, guide, series_0, series_1, series_2, series_3, series_4, series_5, series_6 };

constexpr std::size_t series_inks = 7;
constexpr Ink ink_of_series(std::size_t k) {
  return static_cast<Ink>(static_cast<std::size_t>(Ink::series_0) + k % series_inks);
}

Colour colour_of(Ink pen);
/// Darker where the colour would be pale for letters.
Colour letter_colour(Ink pen);
/// "text", "quiet", "grid", "guide", "s0" ... "s6"
std::string name_of(Ink pen);

struct Sheet {
  struct Stroke {
    std::vector<Point> points;
    Ink ink = Ink::text;
    double width = 1;
    double dash = 0;  // length of a dash and of a gap; 0: no gaps
  };
  /// A mark of one of five shapes.
  struct Sign {
    Point at;
    double radius = 1;
    std::size_t shape = 0;
    Ink ink = Ink::text;
    bool filled = false;
    std::string told{};  // who points at it reads this; may have several lines
  };
  struct Words {
    Point at;
    std::string text;  // one line
    int size = 19;
    Ink ink = Ink::text;
    Across across = Across::left;
    Along along = Along::bottom;
    bool upwards = false;
  };

  int width = 1280, height = 960;
  std::string title, told;  // what it shows, for those who do not see it
  std::vector<Stroke> strokes;
  std::vector<Sign> signs;
  std::vector<Words> words;
};

constexpr double line_height = 1.25;  // of a text, in its size

/// The place that a text takes.
Rectangle box_of(const Sheet::Words& words);
/// The place that a sign takes.
Rectangle box_of(const Sheet::Sign& sign);
/// The corners of a sign, round it.
std::vector<Point> corners_of(const Sheet::Sign& sign);

/// The colour as "#0072b2".
std::string hexadecimal(const Colour& colour);

/// A drawing in SVG 1.1: a file of its own, or a part of a page, without colours of its own but with classes. Words are
/// text. Signs that tell something have a title, which a browser shows.
std::string svg_of(const Sheet& sheet);
std::string inline_svg_of(const Sheet& sheet);

/// A PDF of one page. Its words are text in Helvetica, which every reader has; letters that this and Symbol lack become
/// question marks.
std::string pdf_of(const Sheet& sheet);

/// Puts it on a canvas of its size.
void paint(const Sheet& sheet, Canvas& canvas);

}  // namespace gaussdrift::render
