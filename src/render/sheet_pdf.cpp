// A sheet as a PDF of one page: a stream of lines and texts (PDF 1.4, ISO 32000-1, sections 8.5 and 9.4).
#include <fmt/format.h>

#include <string_view>
#include <utility>

#include "render/letters.hpp"
#include "render/sheet.hpp"

namespace gaussdrift::render {
namespace {

constexpr double points_a_pixel = 0.45;  // 1280 x 960 pixels are 8 x 6 inches

/// The letter of a font that shows a code point.
struct Letter {
  char font;  // 'F' Helvetica, 'S' Symbol
  unsigned char byte;
};

Letter letter_of(char32_t code) {
  constexpr std::u32string_view greek = U"αβχδεφγηικλμνοπθρστυωξψζΑΒΧΔΕΦΓΗΙΚΛΜΝΟΠΘΡΣΤΥΩΞΨΖ";
  constexpr std::string_view of_greek = "abcdefghiklmnopqrstuwxyzABCDEFGHIKLMNOPQRSTUWXYZ";
  constexpr std::u32string_view signs = U"−∞≤≥≈→∂∇∫√≠";
  constexpr std::string_view of_signs = "\x2d\xa5\xa3\xb3\xbb\xae\xb6\xd1\xf2\xd6\xb9";
  constexpr std::u32string_view quotes = U"…‘’“”•–—€";
  constexpr std::string_view of_quotes = "\x85\x91\x92\x93\x94\x95\x96\x97\x80";
  const auto found = [code](std::u32string_view in, std::string_view bytes) {
    const std::size_t at = in.find(code);
    return at == in.npos ? '\0' : bytes[at];
  };
  if ((code >= U' ' && code <= U'~') || (code >= 0xA0 && code < 0x100)) return {'F', static_cast<unsigned char>(code)};
  if (const char byte = found(quotes, of_quotes)) return {'F', static_cast<unsigned char>(byte)};
  if (const char byte = found(greek, of_greek)) return {'S', static_cast<unsigned char>(byte)};
  if (const char byte = found(signs, of_signs)) return {'S', static_cast<unsigned char>(byte)};
  return {'F', '?'};
}

/// A string of one font in one height.
std::string shown(const std::string& bytes, char font, bool is_raised, double size) {
  std::string text = "(";
  for (const char c : bytes) {
    if (c == '(' || c == ')' || c == '\\')
      text += std::string("\\") + c;
    else if (const auto byte = static_cast<unsigned char>(c); byte < 0x80)
      text += c;
    else
      text += fmt::format("\\{:03o}", byte);
  }
  return fmt::format("/{} {:.2f} Tf {:.2f} Ts {}) Tj\n", font, is_raised ? 0.72 * size : size,
                     is_raised ? 0.38 * size : 0., text);
}

std::string letters(const std::string& text, double size) {
  std::string all, bytes;
  char font = 'F';
  bool is_raised = false;
  const auto put = [&] {
    if (!bytes.empty()) all += shown(bytes, font, is_raised, size);
    bytes.clear();
  };
  for (const char32_t code : code_points(text)) {
    const char32_t up = raised(code);
    const Letter letter = up == U'-' ? letter_of(U'−') : letter_of(up ? up : code);
    if (letter.font != font || (up != 0) != is_raised) put();
    font = letter.font, is_raised = up != 0;
    bytes += static_cast<char>(letter.byte);
  }
  put();
  return all;
}

std::string colour(const Colour& colour, const char* command) {
  return fmt::format("{:.3f} {:.3f} {:.3f} {}\n", colour[0] / 255., colour[1] / 255., colour[2] / 255., command);
}

std::string way(const std::vector<Point>& points) {
  std::string text;
  for (const Point& p : points) text += fmt::format("{:.2f} {:.2f} {}\n", p.x, p.y, text.empty() ? "m" : "l");
  return text;
}

std::string words_of(const Sheet::Words& words) {
  const Rectangle box = box_of(words);
  const double below = 0.36 * words.size, width = narrow_letters_width(words.text, words.size);
  const int along = words.upwards ? static_cast<int>(words.along) : static_cast<int>(words.across);
  const double back = 0.5 * along * width;
  const std::string place =
      words.upwards ? fmt::format("0 1 -1 0 {:.2f} {:.2f} Tm\n", box.x + box.width / 2 + below, words.at.y - back)
                    : fmt::format("1 0 0 1 {:.2f} {:.2f} Tm\n", words.at.x - back, box.y + box.height / 2 - below);
  return colour(letter_colour(words.ink), "rg") + "BT\n" + place + letters(words.text, words.size) + "ET\n";
}

std::string content_of(const Sheet& sheet) {
  std::string text = fmt::format("{0} 0 0 {0} 0 0 cm\n1 j 1 J\n", points_a_pixel);
  for (const Sheet::Stroke& stroke : sheet.strokes) {
    if (stroke.points.empty()) continue;
    text += colour(colour_of(stroke.ink), "RG") + fmt::format("{:.2f} w ", stroke.width) +
            (stroke.dash > 0 ? fmt::format("0 J [{:.2f}] 0 d\n", stroke.dash) : "1 J [] 0 d\n") + way(stroke.points) +
            "S\n";
  }
  text += "[] 0 d\n";
  for (const Sheet::Sign& sign : sheet.signs)
    text += colour(colour_of(sign.ink), "RG") + colour(colour_of(sign.ink), "rg") +
            fmt::format("{:.2f} w\n", 0.37 * sign.radius) + way(corners_of(sign)) + (sign.filled ? "b\n" : "s\n");
  for (const Sheet::Words& words : sheet.words) text += words_of(words);
  return text;
}

/// The text in UTF-16, as the dictionary of a document has it.
std::string document_text(const std::string& text) {
  std::string hex = "<FEFF";
  for (const char32_t code : code_points(text)) {
    if (code < 0x10000)
      hex += fmt::format("{:04X}", static_cast<unsigned>(code));
    else
      hex += fmt::format("{:04X}{:04X}", 0xD800 + ((static_cast<unsigned>(code) - 0x10000) >> 10),
                         0xDC00 + (static_cast<unsigned>(code) & 0x3FF));
  }
  return hex + ">";
}

}  // namespace

std::string pdf_of(const Sheet& sheet) {
  const std::string content = content_of(sheet);
  const std::vector<std::string> objects{
      "<< /Type /Catalog /Pages 2 0 R >>",
      "<< /Type /Pages /Kids [3 0 R] /Count 1 >>",
      fmt::format("<< /Type /Page /Parent 2 0 R /MediaBox [0 0 {:.1f} {:.1f}] /Contents 4 0 R\n"
                  "   /Resources << /Font << /F 5 0 R /S 6 0 R >> >> >>",
                  points_a_pixel * sheet.width, points_a_pixel * sheet.height),
      fmt::format("<< /Length {} >>\nstream\n{}endstream", content.size(), content),
      "<< /Type /Font /Subtype /Type1 /BaseFont /Helvetica /Encoding /WinAnsiEncoding >>",
      "<< /Type /Font /Subtype /Type1 /BaseFont /Symbol >>",
      fmt::format("<< /Title {} >>", document_text(sheet.title))};
  std::string pdf = "%PDF-1.4\n", places = "0000000000 65535 f \n";
  for (std::size_t i = 0; i < objects.size(); ++i) {
    places += fmt::format("{:010} 00000 n \n", pdf.size());
    pdf += fmt::format("{} 0 obj\n{}\nendobj\n", i + 1, objects[i]);
  }
  return pdf + fmt::format("xref\n0 {0}\n{1}trailer\n<< /Size {0} /Root 1 0 R /Info 7 0 R >>\nstartxref\n{2}\n%%EOF\n",
                           objects.size() + 1, places, pdf.size());
}

}  // namespace gaussdrift::render
