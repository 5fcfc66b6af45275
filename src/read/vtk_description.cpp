#include "read/vtk_description.hpp"

#include <fmt/format.h>
#include <vtkXMLDataElement.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <optional>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "base/text_file.hpp"
#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

namespace {

constexpr int largest_index = 1000000000;  // VTK adds to them
// Before a file is opened: the numbers that are read as text, three times as long, and a line for each of a million
// times.
constexpr double largest_data_file = 3 * 8 * most_numbers, largest_series_file = 2e8;

std::string_view or_empty(const char* text) { return text ? text : ""; }

std::string shown(std::string_view text) { return base::in_quotes(text, 60); }

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
std::optional<std::array<Number, n>> attribute(const std::filesystem::path& file, vtkXMLDataElement* element,
                                               const char* name, const char* what) {
  const char* text = element->GetAttribute(name);
  if (!text) return std::nullopt;
  auto numbers = numbers_in<Number, n>(text);
  if (!numbers)
    throw GridFileError(fmt::format("{}: {} = {} is not {}", line_of(file, element), name, shown(text), what));
  return numbers;
}

Extent extent_of(const std::filesystem::path& file, vtkXMLDataElement* element, const char* name) {
  const auto extent = attribute<int, 6>(file, element, name, "six whole numbers");
  if (!extent)
    throw GridFileError(fmt::format("{}: this <{}> has no {}", line_of(file, element), element->GetName(), name));
  for (std::size_t k = 0; k < 3; ++k) {
    const int first = (*extent)[2 * k], last = (*extent)[2 * k + 1];
    const auto complain = [&](const std::string& what) {
      throw GridFileError(fmt::format("{}: {} = {} {} along {}", line_of(file, element), name,
                                      shown(element->GetAttribute(name)), what, "xyz"[k]));
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
  std::vector<std::vector<double>> fill_values;
  std::vector<std::string> types;
};

/// The arrays of <PointData> and <CellData> of a piece.
Arrays arrays_of(const std::filesystem::path& file, vtkXMLDataElement* piece) {
  Arrays arrays;
  for (int k = 0; k < piece->GetNumberOfNestedElements(); ++k) {
    vtkXMLDataElement* home = piece->GetNestedElement(k);
    const std::string_view kind = or_empty(home->GetName());
    if (kind != "PointData" && kind != "CellData") continue;
    for (int i = 0; i < home->GetNumberOfNestedElements(); ++i) {
      vtkXMLDataElement* item = home->GetNestedElement(i);
      if (!item->GetAttribute("Name")) continue;  // VTK passes it by
      ArrayInfo info{item->GetAttribute("Name"), 1, kind == "CellData"};
      const auto whole = [&](const char* name, long long least, long long most) {
        const auto number = attribute<long long, 1>(file, item, name, "a whole number");
        if (number && ((*number)[0] < least || (*number)[0] > most))
          throw GridFileError(fmt::format("{}: {} = \"{}\" of the array \"{}\" must be at least {} and at most {}",
                                          line_of(file, item), name, (*number)[0], info.name, least, most));
        return number ? (*number)[0] : least;
      };
      info.components = static_cast<std::size_t>(whole("NumberOfComponents", 1, 1000));
      whole("offset", 0, std::numeric_limits<long long>::max());
      if (item->GetAttribute("TimeStep"))
        throw GridFileError(
            fmt::format("{}: the array \"{}\" has several times in one file", line_of(file, item), info.name),
            "a series of times is a .pvd with a file for each");
      for (std::size_t j = 0; j < arrays.list.size(); ++j)
        if (arrays.list[j].name == info.name && arrays.list[j].on_cells == info.on_cells)
          throw GridFileError(fmt::format("{}: two arrays have the name \"{}\"", line_of(file, item), info.name));
      std::vector<double> fills;
      for (const char* name : {"_FillValue", "missing_value", "FillValue", "fill_value"})
        if (const char* text = item->GetAttribute(name)) {
          const auto number = base::read_number<double>(text);
          if (!number)
            throw GridFileError(fmt::format("{}: {} = {} is not a number", line_of(file, item), name, shown(text)));
          fills.push_back(*number);
        }
      arrays.list.push_back(info);
      arrays.fill_values.push_back(fills);
      arrays.types.emplace_back(or_empty(item->GetAttribute("type")));
    }
  }
  return arrays;
}

bool same(const Arrays& a, const Arrays& b) {
  if (a.list.size() != b.list.size() || a.types != b.types) return false;
  for (std::size_t i = 0; i < a.list.size(); ++i)
    if (a.list[i].name != b.list[i].name || a.list[i].components != b.list[i].components ||
        a.list[i].on_cells != b.list[i].on_cells)
      return false;
  return true;
}

void read_image_attributes(const std::filesystem::path& file, vtkXMLDataElement* grid, Description& result) {
  if (const auto origin = attribute<double, 3>(file, grid, "Origin", "three numbers")) result.origin = *origin;
  if (const auto spacing = attribute<double, 3>(file, grid, "Spacing", "three numbers")) result.spacing = *spacing;
  for (const auto& [name, rounding] :
       {std::pair{"Origin", &result.origin_rounding}, std::pair{"Spacing", &result.spacing_rounding}}) {
    Words words(or_empty(grid->GetAttribute(name)));
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
                                      shown(grid->GetAttribute("Direction"))),
                          "ParaView's filter Resample To Image puts it on a grid along the axes");
    if (diagonal) result.spacing[k / 4] *= value;
  }
}

}  // namespace

void check_readable(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw GridFileError(fmt::format("there is no file {}", file.string()),
                        "paths are relative to the folder of the case file");
  if (const std::string other = base::what_else_it_is(file); !other.empty())
    throw GridFileError(fmt::format("{} is {}, not a file of data", file.string(), other));
  if (!std::filesystem::is_regular_file(file, error))
    throw GridFileError(fmt::format("{} is a pipe", file.string()),
                        "data on a grid are read several times: write them to a file");
  if (!std::ifstream(file, std::ios::binary))
    throw GridFileError(fmt::format("the file {} cannot be read", file.string()));
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  const double most = file.extension() == ".pvd" ? largest_series_file : largest_data_file;
  if (!error && static_cast<double>(bytes) > most)
    throw GridFileError(fmt::format("{} has {:.3g} MB; at most {:.3g} MB are read", file.string(),
                                    static_cast<double>(bytes) / 1e6, most / 1e6),
                        "leave times or points out");
}

LineCounter::LineCounter(const std::filesystem::path& file) : stream_(file, std::ios::binary), block_(65536) {}

std::size_t LineCounter::line(vtkXMLDataElement* element) {
  for (const auto index = element->GetXMLByteIndex(); at_ < index && stream_;) {
    stream_.read(block_.data(), std::min<std::streamsize>(index - at_, static_cast<std::streamsize>(block_.size())));
    lines_ += static_cast<std::size_t>(std::count(block_.begin(), block_.begin() + stream_.gcount(), '\n'));
    at_ += stream_.gcount();
  }
  return lines_;
}

std::string line_of(const std::filesystem::path& file, vtkXMLDataElement* element) {
  return fmt::format("{}:{}", file.filename().string(), LineCounter(file).line(element));
}

bool Description::covered(bool cells) const {
  // The borders of all pieces cut the extent into boxes; a piece covers whole boxes.
  std::array<std::vector<int>, 3> cuts;
  const auto end = [&](const Extent& box, std::size_t k) {
    const bool thin = extent[2 * k] == extent[2 * k + 1];  // one layer of points, and one of cells
    return box[2 * k + 1] + (cells && !thin ? 0 : 1);
  };
  std::size_t boxes = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    cuts[k] = {extent[2 * k], end(extent, k)};
    for (const Extent& piece : pieces) cuts[k].push_back(piece[2 * k]), cuts[k].push_back(end(piece, k));
    std::sort(cuts[k].begin(), cuts[k].end());
    cuts[k].erase(std::unique(cuts[k].begin(), cuts[k].end()), cuts[k].end());
    boxes *= cuts[k].size() - 1;
    if (boxes > 100000000) throw GridFileError("the grid lies in too many pieces");
  }
  std::vector<bool> is_covered(boxes);
  const auto index = [&](std::size_t k, int cut) {
    return static_cast<std::size_t>(std::lower_bound(cuts[k].begin(), cuts[k].end(), cut) - cuts[k].begin());
  };
  for (const Extent& piece : pieces)
    for (std::size_t c = index(2, piece[4]); c < index(2, end(piece, 2)); ++c)
      for (std::size_t b = index(1, piece[2]); b < index(1, end(piece, 1)); ++b)
        for (std::size_t a = index(0, piece[0]); a < index(0, end(piece, 0)); ++a)
          is_covered[(c * (cuts[1].size() - 1) + b) * (cuts[0].size() - 1) + a] = true;
  return std::all_of(is_covered.begin(), is_covered.end(), [](bool one) { return one; });
}

Description describe_grid(vtkXMLDataElement* grid, const std::filesystem::path& file, bool image) {
  Description result;
  result.extent = extent_of(file, grid, "WholeExtent");
  std::vector<vtkXMLDataElement*> pieces;
  for (int k = 0; k < grid->GetNumberOfNestedElements(); ++k)
    if (or_empty(grid->GetNestedElement(k)->GetName()) == "Piece") pieces.push_back(grid->GetNestedElement(k));
  for (vtkXMLDataElement* piece : pieces) {
    result.pieces.push_back(extent_of(file, piece, "Extent"));
    if (!lies_in(result.pieces.back(), result.extent))
      throw GridFileError(fmt::format("{}: Extent = {} of this piece reaches beyond WholeExtent = {}",
                                      line_of(file, piece), shown(piece->GetAttribute("Extent")),
                                      shown(grid->GetAttribute("WholeExtent"))));
  }
  if (pieces.empty()) {  // the grid itself is the one piece
    pieces.push_back(grid);
    result.pieces.push_back(result.extent);
  }
  const Arrays first = arrays_of(file, pieces.front());
  for (vtkXMLDataElement* piece : pieces)  // VTK takes them by their order
    if (!same(arrays_of(file, piece), first))
      throw GridFileError(
          fmt::format("{}: this piece has other arrays than the first one, or in another order", line_of(file, piece)));
  for (std::size_t i = 0; i < first.list.size(); ++i) {
    if (first.types[i] == "String") continue;
    result.arrays.push_back(first.list[i]);
    result.fill_values.push_back(first.fill_values[i]);
  }
  if (image) read_image_attributes(file, grid, result);
  for (int k = 0; k < grid->GetNumberOfNestedElements(); ++k) {
    vtkXMLDataElement* fields = grid->GetNestedElement(k);
    if (or_empty(fields->GetName()) != "FieldData") continue;
    for (int i = 0; i < fields->GetNumberOfNestedElements(); ++i)
      for (const char* name : {"NumberOfTuples", "NumberOfComponents"}) {
        vtkXMLDataElement* item = fields->GetNestedElement(i);
        const auto number = attribute<long long, 1>(file, item, name, "a whole number");
        if (number && ((*number)[0] < 0 || (*number)[0] > largest_index))
          throw GridFileError(fmt::format("{}: {} = \"{}\" is out of range", line_of(file, item), name, (*number)[0]));
      }
  }
  return result;
}

std::vector<double> numbers_in_text(const std::filesystem::path& file, vtkXMLDataElement* array) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(array->GetXMLByteIndex());
  stream.ignore(std::numeric_limits<std::streamsize>::max(), '>');
  std::vector<char> block(65536);
  std::string word;
  std::vector<double> numbers;
  const auto take = [&] {
    if (word.empty()) return;
    const auto number = base::read_number<double>(word);
    if (!number)
      throw GridFileError(fmt::format("{}: {} is not a number: value {} of the array \"{}\"", line_of(file, array),
                                      shown(word), numbers.size() + 1, or_empty(array->GetAttribute("Name"))));
    numbers.push_back(*number);
    word.clear();
  };
  for (bool inside = true; inside && stream;) {
    stream.read(block.data(), static_cast<std::streamsize>(block.size()));
    for (std::streamsize i = 0; i < stream.gcount(); ++i) {
      const char c = block[static_cast<std::size_t>(i)];
      inside = c != '<';
      if (!inside) break;
      if (c == ' ' || c == '\t' || c == '\n' || c == '\r')
        take();
      else
        word += c;
    }
  }
  take();
  return numbers;
}

}  // namespace gaussdrift::read
