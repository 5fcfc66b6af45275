#include "read/point_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "read/file_bytes.hpp"
#include "read/grid_file_error.hpp"
#include "read/number_array.hpp"
#include "read/stored_grid.hpp"
#include "read/xml_tree.hpp"

namespace gaussdrift::read {

namespace {

constexpr const char* as_points = "ParaView opens the file: File, Save Data, as .csv or, of points alone, as .vtp";

std::size_t whole_number(const FileBytes& file, const Element& element, const char* key) {
  const std::string* text = element.attribute(key);
  const auto number = text ? base::read_number<std::size_t>(*text) : std::nullopt;
  if (!number)
    throw GridFileError(
        fmt::format("{}: <{}> must have {}=\"...\", a whole number", line_of(file, element), element.name, key));
  return *number;
}

std::size_t components_of(const FileBytes& file, const Element& array) {
  if (!array.attribute("NumberOfComponents")) return 1;
  const std::size_t components = whole_number(file, array, "NumberOfComponents");
  constexpr std::size_t most = 9;
  if (components < 1 || components > most)
    throw GridFileError(
        fmt::format("{}: an array has {} components; 1 to {} are read", line_of(file, array), components, most));
  return components;
}

}  // namespace

struct PointFile::Parts {
  struct Array {
    const Element* element;
    std::size_t components;
  };
  struct Column {
    std::size_t array, component;
  };

  explicit Parts(const std::filesystem::path& path) : file(path), xml(read_xml(file)) {
    const std::string* type = xml.root.attribute("type");
    const Element* data = xml.root.child("PolyData");
    if (xml.root.name != "VTKFile" || !type || *type != "PolyData" || !data)
      throw GridFileError(fmt::format("{} is not a file of points: that has <VTKFile type=\"PolyData\"> and a "
                                      "<PolyData> inside (.vtp)",
                                      file.name()),
                          as_points);
    form = binary_form(file, xml);
    const auto pieces = std::count_if(data->children.begin(), data->children.end(),
                                      [](const Element& child) { return child.name == "Piece"; });
    if (pieces != 1)
      throw GridFileError(fmt::format("{} has {} pieces; the points of one are read", file.name(), pieces), as_points);
    describe(*data->child("Piece"));
  }

  void describe(const Element& piece) {
    size = whole_number(file, piece, "NumberOfPoints");
    if (static_cast<double>(size) > most_numbers / 3)
      throw GridFileError(
          fmt::format("{} tells of {} points; at most {:.0f} are read", file.name(), size, most_numbers / 3));
    const Element* points = piece.child("Points");
    const Element* places = points ? points->child("DataArray") : nullptr;
    if (!places || !holds_numbers(*places) || components_of(file, *places) != 3)
      throw GridFileError(
          fmt::format("{} has no places of points: <Points> with an array of 3 components", file.name()), as_points);
    add(*places, {"x", "y", "z"});
    const Element* data = piece.child("PointData");
    if (!data) return;
    for (const Element& array : data->children) {
      const std::string* name = array.attribute("Name");
      if (!name || !holds_numbers(array)) continue;
      const std::size_t components = components_of(file, array);
      std::vector<std::string> called{*name};
      if (components > 1) called.clear();
      for (std::size_t k = 0; k < components && components > 1; ++k) called.push_back(fmt::format("{}:{}", *name, k));
      add(array, called);
    }
  }

  void add(const Element& array, const std::vector<std::string>& its_names) {
    constexpr std::size_t most_columns = 10000;
    if (names.size() + its_names.size() > most_columns)
      throw GridFileError(fmt::format("{} has more than {} arrays", file.name(), most_columns));
    for (std::size_t k = 0; k < its_names.size(); ++k) {
      names.push_back(its_names[k]);
      columns.push_back({arrays.size(), k});
    }
    arrays.push_back({&array, its_names.size()});
  }

  void check(std::size_t array) { check_length(file, form, *arrays[array].element, size * arrays[array].components); }
  std::vector<double> numbers_of(std::size_t array) {
    return read_numbers(file, form, *arrays[array].element, size * arrays[array].components);
  }

  FileBytes file;
  XmlFile xml;
  BinaryForm form;
  std::size_t size = 0;
  std::vector<Array> arrays;
  std::vector<std::string> names;
  std::vector<Column> columns;
};

PointFile::PointFile(const std::filesystem::path& file) : parts_(std::make_unique<Parts>(file)) {}
PointFile::~PointFile() = default;

std::size_t PointFile::size() const { return parts_->size; }
const std::vector<std::string>& PointFile::columns() const { return parts_->names; }

std::vector<double> PointFile::read(const std::vector<std::size_t>& wanted) {
  std::vector<std::size_t> needed;
  for (const std::size_t column : wanted) needed.push_back(parts_->columns[column].array);
  std::sort(needed.begin(), needed.end());
  needed.erase(std::unique(needed.begin(), needed.end()), needed.end());
  for (const std::size_t array : needed) parts_->check(array);
  std::vector<double> rows(wanted.size() * parts_->size);
  for (const std::size_t array : needed) {
    const std::vector<double> numbers = parts_->numbers_of(array);
    const std::size_t components = parts_->arrays[array].components;
    for (std::size_t k = 0; k < wanted.size(); ++k) {
      const Parts::Column& column = parts_->columns[wanted[k]];
      if (column.array != array) continue;
      for (std::size_t i = 0; i < parts_->size; ++i)
        rows[i * wanted.size() + k] = numbers[i * components + column.component];
    }
  }
  return rows;
}

bool PointFile::is_flat() {
  parts_->check(0);
  const std::vector<double> places = parts_->numbers_of(0);
  for (std::size_t i = 2; i < places.size(); i += 3)
    if (places[i] != 0) return false;
  return true;
}

}  // namespace gaussdrift::read
