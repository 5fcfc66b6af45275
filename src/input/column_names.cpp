#include "input/column_names.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "base/printable.hpp"

namespace gaussdrift::input {
namespace {

std::string in_small_letters(std::string_view name) {
  std::string text(name);
  for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

template <class Words>
bool holds(const Words& words, std::string_view word) {
  return std::find(std::begin(words), std::end(words), word) != std::end(words);
}

/// Every line one more than the line before it.
bool counts(const std::vector<double>& numbers, std::size_t columns, std::size_t column) {
  const std::size_t rows = numbers.size() / columns;
  if (rows < 3) return false;
  const double first = numbers[column];
  if (first != 0 && first != 1) return false;
  for (std::size_t row = 0; row < rows; ++row)
    if (numbers[row * columns + column] != first + static_cast<double>(row)) return false;
  return true;
}

}  // namespace

bool names_an_axis(std::string_view name) {
  static constexpr std::string_view words[] = {"lon",      "lat",    "alt",   "longitude", "latitude",
                                               "altitude", "height", "depth", "easting",   "northing",
                                               "east",     "north",  "up",    "elevation", "level"};
  std::string text = in_small_letters(name);
  if (holds(words, text)) return true;
  while (text.size() > 1 && (std::isdigit(static_cast<unsigned char>(text.back())) || text.back() == '_' ||
                             text.back() == ']' || text.back() == '['))
    text.pop_back();
  return text == "x" || text == "y" || text == "z" || text == "w";
}

bool names_no_coordinate(std::string_view name) {
  static constexpr std::string_view words[] = {
      "id",     "ids",     "idx",   "index", "i",        "j",           "k",        "n",         "no",        "nr",
      "num",    "number",  "count", "row",   "line",     "key",         "label",    "name",      "type",      "tag",
      "group",  "class",   "cell",  "node",  "point",    "point_id",    "particle", "pid",       "gid",       "uid",
      "time",   "t",       "times", "date",  "datetime", "timestamp",   "step",     "frame",     "iteration", "iter",
      "second", "seconds", "hour",  "day",   "month",    "year",        "mass",     "charge",    "q",         "value",
      "values", "density", "rho",   "u",     "v",        "temperature", "pressure", "unnamed: 0"};
  return holds(words, in_small_letters(name));
}

std::vector<std::string> doubtful_coordinates(const std::vector<std::string>& names,
                                              const std::vector<double>& numbers) {
  const bool has_axes = std::any_of(names.begin(), names.end(), names_an_axis);
  std::vector<std::string> doubts;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names_an_axis(names[k])) continue;
    if (counts(numbers, names.size(), k))
      doubts.push_back(
          fmt::format("the column {} counts the lines and is read as a coordinate", base::in_quotes(names[k])));
    else if (has_axes)
      doubts.push_back(fmt::format("the column {} is read as a coordinate", base::in_quotes(names[k])));
  }
  return doubts;
}

std::string listed(const std::vector<std::string>& names, std::string_view separator) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t k = 0; k < std::min(most, names.size()); ++k)
    text += fmt::format("{}{}", k ? separator : "", base::printable(base::shortened(names[k], 24)));
  if (names.size() > most) text += fmt::format("{}... ({} in all)", separator, names.size());
  return text;
}

}  // namespace gaussdrift::input
