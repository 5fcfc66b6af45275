// A sheet as SVG.
#include <fmt/format.h>

#include "base/escaped.hpp"
#include "render/letters.hpp"
#include "render/sheet.hpp"

namespace gaussdrift::render {
namespace {

class SvgWriter {
 public:
  SvgWriter(const Sheet& sheet, bool is_file) : sheet_(sheet), is_file_(is_file) {}

  std::string text() const {
    std::string svg =
        fmt::format("<svg {}viewBox=\"0 0 {} {}\" role=\"img\"{}>\n<title>{}</title>\n<desc>{}</desc>\n",
                    is_file_ ? fmt::format("xmlns=\"http://www.w3.org/2000/svg\" width=\"{}\" height=\"{}\" ",
                                           sheet_.width, sheet_.height)
                             : "class=\"chart\" ",
                    sheet_.width, sheet_.height, is_file_ ? " font-family=\"'DejaVu Sans', Verdana, sans-serif\"" : "",
                    base::escaped(well_formed(sheet_.title)), base::escaped(well_formed(sheet_.told)));
    if (is_file_)
      svg += fmt::format("<rect width=\"{}\" height=\"{}\" fill=\"#ffffff\"/>\n", sheet_.width, sheet_.height);
    for (const Sheet::Stroke& stroke : sheet_.strokes) svg += line(stroke);
    for (const Sheet::Sign& sign : sheet_.signs) svg += mark(sign);
    for (const Sheet::Words& words : sheet_.words) svg += words_of(words);
    return svg + "</svg>\n";
  }

 private:
  std::string places(const std::vector<Point>& points) const {
    std::string text;
    for (const Point& p : points)
      text += fmt::format("{}{:.1f},{:.1f}", text.empty() ? "" : " ", p.x, sheet_.height - p.y);
    return text;
  }

  /// The class, and in a file the colour.
  std::string look(Ink pen, const char* prefix, const char* property, const Colour& colour) const {
    std::string text = fmt::format("class=\"{}{}\"", prefix, name_of(pen));
    if (is_file_) text += fmt::format(" {}=\"{}\"", property, hexadecimal(colour));
    return text;
  }

  std::string line(const Sheet::Stroke& stroke) const {
    return fmt::format("<polyline {} fill=\"none\" stroke-width=\"{:.1f}\"{} points=\"{}\"/>\n",
                       look(stroke.ink, "line ", "stroke", colour_of(stroke.ink)), stroke.width,
                       stroke.dash > 0 ? fmt::format(" stroke-dasharray=\"{:.1f}\"", stroke.dash) : "",
                       places(stroke.points));
  }

  std::string mark(const Sheet::Sign& sign) const {
    std::string text =
        fmt::format("<polygon {}", look(sign.ink, sign.filled ? "full mark " : "mark ", "stroke", colour_of(sign.ink)));
    if (is_file_) text += fmt::format(" fill=\"{}\"", sign.filled ? hexadecimal(colour_of(sign.ink)) : "none");
    text += fmt::format(" stroke-width=\"{:.1f}\" points=\"{}\"", 0.37 * sign.radius, places(corners_of(sign)));
    return text + (sign.told.empty()
                       ? "/>\n"
                       : fmt::format("><title>{}</title></polygon>\n", base::escaped(well_formed(sign.told))));
  }

  std::string words_of(const Sheet::Words& words) const {
    // The letters' own middle is on that of the line.
    const Rectangle box = box_of(words);
    const double middle = 0.36 * words.size;
    const double x = words.upwards ? box.x + box.width / 2 + middle : words.at.x;
    const double y = words.upwards ? sheet_.height - words.at.y : sheet_.height - box.y - box.height / 2 + middle;
    const int along = words.upwards ? static_cast<int>(words.along) : static_cast<int>(words.across);
    const char* anchor = along == 0 ? "" : along == 1 ? " text-anchor=\"middle\"" : " text-anchor=\"end\"";
    return fmt::format("<text {} x=\"{:.1f}\" y=\"{:.1f}\" font-size=\"{}\"{}{}>{}</text>\n",
                       look(words.ink, "", "fill", letter_colour(words.ink)), x, y, words.size, anchor,
                       words.upwards ? fmt::format(" transform=\"rotate(-90 {:.1f} {:.1f})\"", x, y) : "",
                       letters(words));
  }

  /// Exponents are raised and small.
  static std::string letters(const Sheet::Words& words) {
    std::string text, upper;
    const double raise = 0.38 * words.size;
    bool is_back = true;
    const auto put_upper = [&] {
      if (upper.empty()) return;
      text += fmt::format("<tspan dy=\"{:.1f}\" font-size=\"{:.1f}\">{}</tspan>", -raise, 0.72 * words.size, upper);
      upper.clear();
      is_back = false;
    };
    std::string plain;
    const auto put_plain = [&] {
      if (plain.empty()) return;
      text +=
          is_back ? base::escaped(plain) : fmt::format("<tspan dy=\"{:.1f}\">{}</tspan>", raise, base::escaped(plain));
      plain.clear();
      is_back = true;
    };
    for (const char32_t code : code_points(words.text)) {
      if (const char32_t up = raised(code)) {
        put_plain();
        upper += up == U'-' ? "\u2212" : utf8(up);
      } else {
        put_upper();
        plain += utf8(code);
      }
    }
    put_upper();
    put_plain();
    return text;
  }

  const Sheet& sheet_;
  bool is_file_;
};

}  // namespace

std::string svg_of(const Sheet& sheet) { return SvgWriter(sheet, true).text(); }

std::string inline_svg_of(const Sheet& sheet) { return SvgWriter(sheet, false).text(); }

}  // namespace gaussdrift::render
