#include "read/grid_description.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

namespace {

constexpr int largest_index = 1000000000;  // differences are int too
std::string shown(std::string_view text) { return base::in_quotes(text, 60); }

std::string_view value_of(const Element& element, std::string_view name) {
  const std::string* text = element.attribute(name);
  return text ? std::string_view(*text) : std::string_view{};
}

class Words {
 public:
  explicit Words(std::string_view text) : text_(text) {}
  std::optional<std::string_view> next() {
    constexpr std::string_view blanks = " \t\r\n";
    const std::size_t first = text_.find_first_not_of(blanks);
    if (first == std::string_view::npos) return std::nullopt;
    const std::size_t end = std::min(text_.find_first_of(blanks, first), text_.size());
    const std::string_view word = text_.substr(first, end - first);
    text_.remove_prefix(end);
    return word;
  }

 private:
  std::string_view text_;
};

/// Exactly n numbers.
template <class Number, std::size_t n>
std::optional<std::array<Number, n>> numbers_in(std::string_view text) {
  std::array<Number, n> numbers{};
  Words words(text);
  for (Number& number : numbers) {
    const auto word = words.next();
    const auto value = word ? base::read_number<Number>(*word) : std::nullopt;
    if (!value || !std::isfinite(static_cast<double>(*value))) return std::nullopt;
    number = *value;
  }
  return words.next() ? std::nullopt : std::optional(numbers);
}

/// A number that was rounded when it was written has many digits. Then it is wrong by up to a unit of the last one, and
/// by the rounding of single precision if it is one of its numbers to so many digits.
double rounding_of(std::string_view word) {
  const auto value = base::read_number<double>(word);
  const std::size_t exponent = std::min(word.find_first_of("eE"), word.size());
  const std::string_view mantissa = word.substr(0, exponent);
  const std::size_t point = mantissa.find('.'), first = mantissa.find_first_of("123456789");
  if (!value || point == std::string_view::npos || first == std::string_view::npos) return 0;
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto digits = std::count_if(mantissa.begin() + static_cast<std::ptrdiff_t>(first), mantissa.end(), is_digit);
  if (digits < 6) return 0;
  const int places = static_cast<int>(mantissa.size() - point - 1);
  const int power = exponent < word.size() ? base::read_number<int>(word.substr(exponent + 1)).value_or(0) : 0;
  const double unit = std::pow(10.0, power - places);
  const bool single = digits >= 7 && std::abs(*value) <= double(std::numeric_limits<float>::max()) &&
                      std::abs(*value - double(float(*value))) <= unit;
  return single ? std::max(unit, double(std::numeric_limits<float>::epsilon()) * std::abs(*value)) : unit;
}

template <class Number, std::size_t n>
std::optional<std::array<Number, n>> attribute(const FileBytes& file, const Element& element, const char* name,
                                               const char* what) {
  const std::string* text = element.attribute(name);
  if (!text) return std::nullopt;
  auto numbers = numbers_in<Number, n>(*text);
  if (!numbers)
    throw GridFileError(fmt::format("{}: {} = {} is not {}", line_of(file, element), name, shown(*text), what));
  return numbers;
}

Extent extent_of(const FileBytes& file, const Element& element, const char* name) {
  const auto extent = attribute<int, 6>(file, element, name, "six whole numbers");
  if (!extent) throw GridFileError(fmt::format("{}: this <{}> has no {}", line_of(file, element), element.name, name));
  for (std::size_t k = 0; k < 3; ++k) {
    const int first = (*extent)[2 * k], last = (*extent)[2 * k + 1];
    const auto complain = [&](const std::string& what) {
      throw GridFileError(fmt::format("{}: {} = {} {} along {}", line_of(file, element), name,
                                      shown(value_of(element, name)), what, "xyz"[k]));
    };
    if (first > last) complain("has no points");
    if (first < -largest_index || last > largest_index) complain(fmt::format("has an index beyond {}", largest_index));
  }
  return *extent;
}

bool lies_in(const Extent& inner, const Extent& outer) {
  for (std::size_t k = 0; k < 3; ++k)
    if (inner[2 * k] < outer[2 * k] || inner[2 * k + 1] > outer[2 * k + 1]) return false;
  return true;
}

struct Arrays {
  std::vector<ArrayInfo> list;
  std::vector<const Element*> elements;
};

/// The arrays of numbers of <PointData> and <CellData> of a piece.
Arrays arrays_of(const FileBytes& file, const Element& piece) {
  Arrays arrays;
  std::set<std::pair<std::string_view, bool>> names;
  for (const Element& home : piece.children) {
    if (home.name != "PointData" && home.name != "CellData") continue;
    const bool on_cells = home.name == "CellData";
    for (const Element& item : home.children) {
      const std::string* name = item.attribute("Name");
      if (!name) continue;  // nobody can ask for it
      ArrayInfo info{*name, 1, on_cells};
      const auto components = attribute<long long, 1>(file, item, "NumberOfComponents", "a whole number");
      if (components && ((*components)[0] < 1 || (*components)[0] > 1000))
        throw GridFileError(
            fmt::format("{}: NumberOfComponents = \"{}\" of the array {} must be at least 1 and at most 1000",
                        line_of(file, item), (*components)[0], shown(*name)));
      if (components) info.components = static_cast<std::size_t>((*components)[0]);
      if (item.attribute("TimeStep"))
        throw GridFileError(
            fmt::format("{}: the array {} has several times in one file", line_of(file, item), shown(*name)),
            "a series of times is a .pvd with a file for each");
      if (!names.insert({*name, on_cells}).second)
        throw GridFileError(fmt::format("{}: two arrays have the name {}", line_of(file, item), shown(*name)));
      if (value_of(item, "type") == "String") continue;
      arrays.list.push_back(std::move(info));
      arrays.elements.push_back(&item);
    }
  }
  return arrays;
}

/// Numbers that mark missing data.
std::vector<double> fills_of(const FileBytes& file, const Element& array) {
  std::vector<double> fills;
  for (const char* name : {"_FillValue", "missing_value", "FillValue", "fill_value"})
    if (const std::string* text = array.attribute(name)) {
      const auto number = base::read_number<double>(*text);
      if (!number)
        throw GridFileError(fmt::format("{}: {} = {} is not a number", line_of(file, array), name, shown(*text)));
      fills.push_back(*number);
    }
  return fills;
}

bool same(const Arrays& a, const Arrays& b) {
  if (a.list.size() != b.list.size()) return false;
  for (std::size_t i = 0; i < a.list.size(); ++i)
    if (a.list[i].name != b.list[i].name || a.list[i].components != b.list[i].components ||
        a.list[i].on_cells != b.list[i].on_cells ||
        value_of(*a.elements[i], "type") != value_of(*b.elements[i], "type"))
      return false;
  return true;
}

/// The three arrays of <Coordinates>.
std::vector<const Element*> coordinates_of(const FileBytes& file, const Element& piece) {
  std::vector<const Element*> coordinates;
  if (const Element* home = piece.child("Coordinates"))
    for (const Element& axis : home->children) coordinates.push_back(&axis);
  if (coordinates.size() != 3)
    throw GridFileError(fmt::format("{}: this <{}> has coordinates along {} axes, not along 3", line_of(file, piece),
                                    piece.name, coordinates.size()));
  for (const Element* axis : coordinates) {
    const auto components = attribute<long long, 1>(file, *axis, "NumberOfComponents", "a whole number");
    if (components && (*components)[0] != 1)
      throw GridFileError(
          fmt::format("{}: coordinates have one component, not {}", line_of(file, *axis), (*components)[0]));
  }
  return coordinates;
}

/// The one array of <Points>.
const Element* places_of(const FileBytes& file, const Element& piece) {
  const Element* home = piece.child("Points");
  if (!home || home->children.size() != 1)
    throw GridFileError(fmt::format("{}: this <{}> needs <Points> with one array", line_of(file, piece), piece.name));
  const Element& places = home->children.front();
  const auto components = attribute<long long, 1>(file, places, "NumberOfComponents", "a whole number");
  if (!components || (*components)[0] != 3)
    throw GridFileError(
        fmt::format("{}: points have 3 components, not {}", line_of(file, places), components ? (*components)[0] : 1));
  return &places;
}

void read_image_attributes(const FileBytes& file, const Element& grid, GridDescription& result) {
  if (const auto origin = attribute<double, 3>(file, grid, "Origin", "three numbers")) result.origin = *origin;
  if (const auto spacing = attribute<double, 3>(file, grid, "Spacing", "three numbers")) result.spacing = *spacing;
  for (const auto& [name, rounding] :
       {std::pair{"Origin", &result.origin_rounding}, std::pair{"Spacing", &result.spacing_rounding}}) {
    Words words(value_of(grid, name));
    for (double& value : *rounding)
      if (const auto word = words.next()) value = rounding_of(*word);
  }
  for (std::size_t k = 0; k < 3; ++k)
    if (result.spacing[k] == 0 && result.extent[2 * k] < result.extent[2 * k + 1])
      throw GridFileError(fmt::format("{}: Spacing is 0 along {}", line_of(file, grid), "xyz"[k]));
  const auto turn = attribute<double, 9>(file, grid, "Direction", "nine numbers");
  for (std::size_t k = 0; turn && k < 9; ++k) {
    const double value = (*turn)[k];
    const bool diagonal = k % 4 == 0;
    if (diagonal ? std::abs(value) != 1 : value != 0)
      throw GridFileError(fmt::format("{}: the image is turned against the axes: Direction = {}", line_of(file, grid),
                                      shown(value_of(grid, "Direction"))),
                          "ParaView's filter Resample To Image puts it on a grid along the axes");
    if (diagonal) result.spacing[k / 4] *= value;
  }
}

}  // namespace

std::array<std::size_t, 3> lengths(const Extent& piece, const Extent& whole, bool cells) {
  std::array<std::size_t, 3> result{};
  for (std::size_t k = 0; k < 3; ++k) {
    const bool thin = whole[2 * k] == whole[2 * k + 1];
    result[k] = static_cast<std::size_t>(piece[2 * k + 1] - piece[2 * k]) + (cells && !thin ? 0 : 1);
  }
  return result;
}

bool GridDescription::covered(bool cells) const {
  if (pieces.size() == 1) return pieces[0].extent == extent;
  const auto all = lengths(extent, extent, cells);
  std::vector<bool> is_covered(all[0] * all[1] * all[2]);
  for (const Piece& piece : pieces)
    for_rows(piece.extent, extent, cells, [&](std::size_t first, std::size_t count) {
      std::fill_n(is_covered.begin() + static_cast<std::ptrdiff_t>(first), count, true);
    });
  return std::find(is_covered.begin(), is_covered.end(), false) == is_covered.end();
}

bool GridDescription::overlaps() const {
  const auto all = lengths(extent, extent, true);
  std::vector<bool> is_taken(all[0] * all[1] * all[2]);
  bool found = false;
  for (const Piece& piece : pieces)
    for_rows(piece.extent, extent, true, [&](std::size_t first, std::size_t count) {
      const auto begin = is_taken.begin() + static_cast<std::ptrdiff_t>(first),
                 end = begin + static_cast<std::ptrdiff_t>(count);
      found = found || std::find(begin, end, true) != end;
      std::fill(begin, end, true);
    });
  return found;
}

GridDescription describe_grid(const FileBytes& file, const Element& grid, GridKind kind) {
  GridDescription result;
  result.extent = extent_of(file, grid, "WholeExtent");
  std::vector<const Element*> pieces;
  for (const Element& child : grid.children)
    if (child.name == "Piece") pieces.push_back(&child);
  for (const Element* piece : pieces) {
    result.pieces.push_back({extent_of(file, *piece, "Extent"), {}, {}});
    if (!lies_in(result.pieces.back().extent, result.extent))
      throw GridFileError(fmt::format("{}: Extent = {} of this piece reaches beyond WholeExtent = {}",
                                      line_of(file, *piece), shown(value_of(*piece, "Extent")),
                                      shown(value_of(grid, "WholeExtent"))));
  }
  if (pieces.empty()) {  // the grid itself is the one piece
    pieces.push_back(&grid);
    result.pieces.push_back({result.extent, {}, {}});
  }
  const Arrays first = arrays_of(file, *pieces.front());
  for (std::size_t k = 0; k < pieces.size(); ++k) {  // arrays of pieces belong together by their order
    Arrays arrays = k == 0 ? first : arrays_of(file, *pieces[k]);
    if (!same(arrays, first))
      throw GridFileError(fmt::format("{}: this piece has other arrays than the first one, or in another order",
                                      line_of(file, *pieces[k])));
    result.pieces[k].arrays = std::move(arrays.elements);
    if (kind == GridKind::rectilinear) result.pieces[k].coordinates = coordinates_of(file, *pieces[k]);
    if (kind == GridKind::curved) result.pieces[k].arrays.push_back(places_of(file, *pieces[k]));
  }
  result.arrays = first.list;
  for (const Element* array : first.elements) result.fill_values.push_back(fills_of(file, *array));
  if (kind == GridKind::curved) {
    result.arrays.push_back({"the places of points", 3, false});
    result.fill_values.emplace_back();
  }
  if (kind == GridKind::image) read_image_attributes(file, grid, result);
  if (const Element* fields = grid.child("FieldData"))
    for (const Element& field : fields->children) result.fields.push_back(&field);
  return result;
}

}  // namespace gaussdrift::read
