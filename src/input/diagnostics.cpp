#include "input/diagnostics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "base/printable.hpp"

namespace gaussdrift::input {
namespace {

bool continues_character(char c) { return (static_cast<unsigned char>(c) & 0xC0) == 0x80; }

std::size_t character_count(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return !continues_character(c); }));
}

/// The longest message or note; names in it may be as long as the file.
std::string told(const std::string& text) {
  constexpr std::size_t longest = 2000;
  return base::printable(base::shortened(text, longest));
}

/// Blanks as wide as `before`, then carets under `marked`; tabs stay, so that they reach as far as in the line.
std::string caret_line(std::string_view before, std::string_view marked) {
  std::string carets;
  for (char c : before)
    if (!continues_character(c)) carets += c == '\t' ? '\t' : ' ';
  return carets + std::string(std::max<std::size_t>(1, character_count(marked)), '^');
}

/// A line of the file as it is shown, and the carets below it: printable, and of a long line what is around the place.
struct Shown {
  std::string line, carets;
};

Shown shown(std::string_view line, std::size_t column, std::size_t length) {
  constexpr std::size_t around = 100;  // bytes
  std::string_view before = line.substr(0, std::min(column, line.size()));
  const std::string_view marked = line.substr(before.size(), length),
                         after = line.substr(before.size() + marked.size());
  std::string left;
  if (before.size() > around) {
    before.remove_prefix(before.size() - around);
    while (!before.empty() && continues_character(before.front())) before.remove_prefix(1);
    left = "...";
  }
  left += base::printable_lines(before);
  const std::string middle = base::printable_lines(base::shortened(marked, around));
  const std::string right = base::printable_lines(base::shortened(after, marked.size() > around ? 0 : around));
  return {left + middle + right, caret_line(left, middle)};
}

}  // namespace

bool comes_before(const Place& a, const Place& b) {
  return std::tuple(a.override_index, a.line, a.column) < std::tuple(b.override_index, b.line, b.column);
}

Source::Source(std::string name, std::string_view text, std::vector<std::string> overrides)
    : name_(std::move(name)), overrides_(std::move(overrides)) {
  for (std::size_t first = 0; first <= text.size();) {
    const std::size_t end = std::min(text.find('\n', first), text.size());
    std::string_view line = text.substr(first, end - first);
    if (!line.empty() && line.back() == '\r') line.remove_suffix(1);
    lines_.emplace_back(line);
    first = end + 1;
  }
}

std::string_view Source::line(const Place& place) const {
  if (place.override_index >= 0) return overrides_[static_cast<std::size_t>(place.override_index)];
  return place.line >= 1 && place.line <= lines_.size() ? std::string_view(lines_[place.line - 1]) : std::string_view();
}

std::string_view Source::text(const Place& place) const {
  const std::string_view whole = line(place);
  return place.column < whole.size() ? whole.substr(place.column, place.length) : std::string_view();
}

std::size_t Source::byte_column(std::size_t line_number, std::size_t characters) const {
  const std::string_view whole = line({-1, line_number, 0, 1});
  std::size_t byte = 0;
  for (std::size_t passed = 1; byte < whole.size(); ++byte)
    if (byte > 0 && !continues_character(whole[byte]) && ++passed == characters) break;
  return characters <= 1 ? 0 : byte;
}

Place Source::end() const {
  std::size_t last = lines_.size();
  while (last > 1 && lines_[last - 1].find_first_not_of(" \t") == std::string::npos) --last;
  return {-1, last, lines_[last - 1].size(), 1};
}

void Diagnostics::error(const Place& place, const std::string& message, const std::string& note) {
  errors_.push_back({place, "error", message, note});
}

void Diagnostics::warning(const Place& place, const std::string& message, const std::string& note) {
  warnings_.push_back({place, "warning", message, note});
}

std::string Diagnostics::layout(const Entry& entry) const {
  const Place& place = entry.place;
  const std::string_view line = source_.line(place);
  const std::string_view before = line.substr(0, std::min(place.column, line.size()));
  const Shown lines = shown(line, place.column, source_.text(place).size());
  std::string text = fmt::format("{}: {}\n", entry.kind, told(entry.message));
  std::string margin = "  ";
  if (place.override_index >= 0) {
    text += fmt::format("  --> --set {}\n            {}\n", lines.line, lines.carets);
  } else {
    const std::string number = std::to_string(place.line);
    margin = std::string(number.size(), ' ');
    text += fmt::format("{0}--> {1}:{2}:{3}\n{0} |\n{2} | {4}\n{0} | {5}\n", margin, base::printable(source_.name()),
                        place.line, character_count(before) + 1, lines.line, lines.carets);
  }
  if (!entry.note.empty()) text += fmt::format("{} = {}\n", margin, told(entry.note));
  return text;
}

std::vector<Diagnostics::Entry> Diagnostics::in_file_order(std::vector<Entry> entries) {
  std::stable_sort(entries.begin(), entries.end(),
                   [](const Entry& a, const Entry& b) { return comes_before(a.place, b.place); });
  return entries;
}

std::string Diagnostics::error_text() const {
  std::string text;
  bool in_overrides = false;
  for (const Entry& entry : in_file_order(errors_)) {
    text += layout(entry) + "\n";
    in_overrides = in_overrides || entry.place.override_index >= 0;
  }
  return text + fmt::format("{} error{} in {}{}", errors(), errors() == 1 ? "" : "s", base::printable(source_.name()),
                            in_overrides ? " and --set" : "");
}

std::vector<std::string> Diagnostics::warnings() const {
  std::vector<std::string> texts;
  for (const Entry& entry : in_file_order(warnings_)) {
    std::string text = layout(entry);
    text.pop_back();  // the line's end
    texts.push_back(text);
  }
  return texts;
}

}  // namespace gaussdrift::input
