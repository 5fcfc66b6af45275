#include "read/stored_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

#include "read/grid_description.hpp"
#include "read/grid_file_error.hpp"
#include "read/number_array.hpp"
#include "read/whole_grid.hpp"

namespace gaussdrift::read {

namespace {

// A small file may hold a large grid, for compression makes much of little. Beyond this a file must have a byte for so
// many bytes of memory.
constexpr double small_memory = 64e6, most_memory_for_a_byte = 50;

bool is_mask(const std::string& name) {
  return name == "vtkGhostType" || name == "vtkGhostLevels" || name == "vtkValidPointMask";
}

}  // namespace

struct StoredGrid::Parts {
  explicit Parts(const std::filesystem::path& path) : file(path) {}

  FileBytes file;
  XmlFile xml;
  BinaryForm form;
  GridDescription description;
  std::array<std::size_t, 3> points{};
  std::vector<ArrayInfo> arrays;
  std::vector<ArrayValues> values;
  std::array<std::vector<double>, 3> axis;
  std::array<double, 3> rounding{};
  double time = 0, sphere = 0;
  bool overlapping = false;  // the pieces
  bool curved = false;
  std::vector<double> places;  // of points, where the grid is curved
  double rounding_of_places = 0;
  std::array<std::vector<std::uint8_t>, 2> hidden;  // points, cells
  std::optional<WholeGrid> whole;                   // files that are read at once

  void describe(const std::filesystem::path& path) {
    const bool image = path.extension() == ".vti";
    curved = path.extension() == ".vts";
    const std::string kind = image ? "ImageData" : curved ? "StructuredGrid" : "RectilinearGrid";
    xml = read_xml(file);
    const std::string* type = xml.root.attribute("type");
    const Element* grid = xml.root.child(kind);
    if (xml.root.name != "VTKFile" || !type || *type != kind || !grid)
      throw GridFileError(
          fmt::format("{} is not a file of the kind that its name says: {} has <VTKFile type=\"{}\"> "
                      "and a <{}> inside",
                      file.name(), path.extension().string(), kind, kind));
    form = binary_form(file, xml);
    description = describe_grid(file, *grid,
                                image    ? GridKind::image
                                : curved ? GridKind::curved
                                         : GridKind::rectilinear);
  }

  /// Where an array stands in the description.
  std::optional<std::size_t> find(const std::string& name, bool on_cells) const {
    for (std::size_t i = 0; i < description.arrays.size(); ++i)
      if (description.arrays[i].name == name && description.arrays[i].on_cells == on_cells) return i;
    return std::nullopt;
  }

  std::size_t count(const Extent& extent, bool cells) const {
    const auto along = lengths(extent, description.extent, cells);
    return along[0] * along[1] * along[2];
  }

  /// All that is read must be there before memory is taken for it.
  void check_lengths(const std::vector<std::size_t>& read) {
    for (const Piece& piece : description.pieces) {
      for (const std::size_t i : read) {
        const ArrayInfo& array = description.arrays[i];
        check_length(file, form, *piece.arrays[i], count(piece.extent, array.on_cells) * array.components);
      }
      for (std::size_t k = 0; k < piece.coordinates.size(); ++k)
        check_length(file, form, *piece.coordinates[k], lengths(piece.extent, description.extent, false)[k]);
    }
  }

  /// An array of all pieces.
  std::vector<double> whole_array(std::size_t i) {
    const ArrayInfo& array = description.arrays[i];
    const auto of_piece = [&](const Piece& piece) {
      return read_numbers(file, form, *piece.arrays[i], count(piece.extent, array.on_cells) * array.components);
    };
    if (description.pieces.size() == 1) return of_piece(description.pieces[0]);
    std::vector<double> numbers(count(description.extent, array.on_cells) * array.components);
    std::vector<bool> is_known(overlapping ? numbers.size() : 0);
    for (const Piece& piece : description.pieces) {
      const std::vector<double> some = of_piece(piece);
      std::size_t next = 0;
      for_rows(piece.extent, description.extent, array.on_cells, [&](std::size_t first, std::size_t rows_points) {
        for (std::size_t k = first * array.components; k < (first + rows_points) * array.components; ++k, ++next) {
          if (overlapping && is_known[k] && !same(numbers[k], some[next])) fail_overlap(array.name);
          numbers[k] = some[next];
          if (overlapping) is_known[k] = true;
        }
      });
    }
    return numbers;
  }

  static bool same(double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); }

  [[noreturn]] void fail_overlap(const std::string& name) const {
    throw GridFileError(
        fmt::format("the pieces of {} overlap and have different numbers there in \"{}\"", file.name(), name),
        "write the file again with pieces that have no cells in common");
  }

  /// The first number of a field array; NaN if there is no such array.
  double field_number(const std::string& name) {
    for (const Element* field : description.fields)
      if (const std::string* key = field->attribute("Name"); key && *key == name && holds_numbers(*field))
        return first_number(file, form, *field).value_or(std::numeric_limits<double>::quiet_NaN());
    return std::numeric_limits<double>::quiet_NaN();
  }

  /// Places of points are read as an array of them, the last one of the description.
  void read_places() {
    const std::size_t last = description.arrays.size() - 1;
    places = whole_array(last);
    double largest = 0;
    for (std::size_t i = 0; i < places.size(); ++i) {
      if (!std::isfinite(places[i]))
        throw GridFileError(
            fmt::format("the {} coordinate of point {} of {} is {}", "xyz"[i % 3], i / 3 + 1, file.name(), places[i]));
      largest = std::max(largest, std::abs(places[i]));
    }
    for (const Piece& piece : description.pieces)
      if (is_single_precision(*piece.arrays[last]))
        rounding_of_places = 4 * double(std::numeric_limits<float>::epsilon()) * largest;
    for (std::size_t k = 0; k < 3; ++k)
      for (std::size_t i = 0; i < points[k]; ++i) axis[k].push_back(static_cast<double>(i));
  }

  void read_axes() {
    if (curved) return read_places();
    const GridDescription& about = description;
    for (std::size_t k = 0; k < 3; ++k) {
      const int first = about.extent[2 * k];
      if (about.pieces[0].coordinates.empty()) {
        for (std::size_t i = 0; i < points[k]; ++i)
          axis[k].push_back(about.origin[k] + about.spacing[k] * (first + static_cast<double>(i)));
        const double farthest = std::max(std::abs(double(first)), std::abs(double(about.extent[2 * k + 1])));
        rounding[k] = about.origin_rounding[k] + about.spacing_rounding[k] * farthest;
      } else {
        axis[k].resize(points[k]);
        bool single = false;
        for (const Piece& piece : about.pieces) {
          const Element& coordinates = *piece.coordinates[k];
          const std::vector<double> some =
              read_numbers(file, form, coordinates, lengths(piece.extent, about.extent, false)[k]);
          std::copy(some.begin(), some.end(), axis[k].begin() + (piece.extent[2 * k] - first));
          single = single || is_single_precision(coordinates);
        }
        double largest = 0;
        for (const double x : axis[k]) largest = std::max(largest, std::abs(x));
        if (single)  // a few roundings: spacings may have been added up
          rounding[k] = 4 * double(std::numeric_limits<float>::epsilon()) * largest;
      }
      check_axis(k);
    }
  }

  void check_axis(std::size_t k) const {
    const auto& x = axis[k];
    const bool descends = x.size() > 1 && x[1] < x[0];
    for (std::size_t i = 0; i < x.size(); ++i) {
      if (!std::isfinite(x[i]))
        throw GridFileError(
            fmt::format("the {} coordinate of point {} of {} is {}", "xyz"[k], i + 1, file.name(), x[i]));
      if (i > 0 && (descends ? !(x[i] < x[i - 1]) : !(x[i] > x[i - 1])))
        throw GridFileError(
            fmt::format("the {} coordinates of {} neither ascend nor descend: {} comes after {} at point {}", "xyz"[k],
                        file.name(), x[i], x[i - 1], i + 1));
    }
  }

  void read_masks() {
    constexpr int hidden_point = 2, hidden_cell = 32;  // as VTK's vtkDataSetAttributes has them
    for (const bool cells : {false, true}) {
      auto& mask = hidden[cells];
      const auto hide = [&](const char* name, const auto& is_hidden) {
        const auto at = find(name, cells);
        if (!at) return;
        const std::size_t components = description.arrays[*at].components;
        const std::vector<double> numbers = whole_array(*at);
        mask.resize(numbers.size() / components);
        for (std::size_t i = 0; i < mask.size(); ++i) {
          const double number = numbers[i * components];
          const bool is_int = std::abs(number) < std::numeric_limits<int>::max();  // the masks of VTK are UInt8
          mask[i] = mask[i] || (is_int && is_hidden(static_cast<int>(number)));
        }
      };
      hide("vtkGhostType", [&](int flags) { return (flags & (cells ? hidden_cell : hidden_point)) != 0; });
      if (!cells) hide("vtkValidPointMask", [](int valid) { return valid == 0; });
    }
    if (!hidden[1].empty()) hide_points_of_hidden_cells();
  }

  void load_whole(const std::vector<ArrayInfo>& wanted) {
    for (const ArrayInfo& array : wanted)
      for (std::size_t i = 0; i < whole->arrays.size(); ++i)
        if (whole->arrays[i].name == array.name && whole->arrays[i].on_cells == array.on_cells) {
          values.push_back(whole->values[i]);
          break;
        }
    axis = std::move(whole->axis);
    rounding = whole->rounding;
    hidden = std::move(whole->hidden);
    time = whole->time;
    whole->values.clear();
  }

  /// A point is hidden if all the cells around it are.
  void hide_points_of_hidden_cells() {
    std::array<std::size_t, 3> cells{};
    for (std::size_t k = 0; k < 3; ++k) cells[k] = std::max<std::size_t>(1, points[k] - 1);
    const auto around = [&](std::size_t k, std::size_t i) {  // indices of the cells on both sides of a point
      return std::pair{i == 0 ? 0 : std::min(i, cells[k]) - 1, std::min(i, cells[k] - 1)};
    };
    std::vector<std::uint8_t>& mask = hidden[0];
    mask.resize(points[0] * points[1] * points[2]);
    for (std::size_t p = 0; p < mask.size(); ++p) {
      const auto [a0, a1] = around(0, p % points[0]);
      const auto [b0, b1] = around(1, p / points[0] % points[1]);
      const auto [c0, c1] = around(2, p / points[0] / points[1]);
      bool all = true;
      for (std::size_t c = c0; c <= c1; ++c)
        for (std::size_t b = b0; b <= b1; ++b)
          for (std::size_t a = a0; a <= a1; ++a) all = all && hidden[1][(c * cells[1] + b) * cells[0] + a] != 0;
      if (all) mask[p] = 1;
    }
  }
};

StoredGrid::StoredGrid(const std::filesystem::path& file) : parts_(std::make_unique<Parts>(file)) {
  if (file.extension() == ".vtk" || file.extension() == ".pvti") {
    parts_->whole = file.extension() == ".vtk" ? read_legacy_vtk(file) : read_pvti(file);
    parts_->points = parts_->whole->points;
    parts_->arrays = parts_->whole->arrays;
    return;
  }
  parts_->describe(file);
  const GridDescription& about = parts_->description;
  double count = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    parts_->points[k] = static_cast<std::size_t>(about.extent[2 * k + 1] - about.extent[2 * k]) + 1;
    count *= static_cast<double>(parts_->points[k]);
  }
  if (count > most_numbers)
    throw GridFileError(
        fmt::format("{} has {:.3g} points; at most {:.3g} numbers are read", parts_->file.name(), count, most_numbers),
        "leave points out");
  for (const ArrayInfo& array : about.arrays)
    if (!is_mask(array.name)) parts_->arrays.push_back(array);
  if (parts_->curved) parts_->arrays.pop_back();  // the places
}

StoredGrid::~StoredGrid() = default;

const std::array<std::size_t, 3>& StoredGrid::points() const { return parts_->points; }
const std::vector<ArrayInfo>& StoredGrid::arrays() const { return parts_->arrays; }
const std::vector<ArrayValues>& StoredGrid::values() const { return parts_->values; }
const std::vector<double>& StoredGrid::axis(std::size_t k) const { return parts_->axis[k]; }
const std::vector<double>& StoredGrid::places() const { return parts_->places; }
double StoredGrid::rounding_of_places() const { return parts_->rounding_of_places; }
double StoredGrid::rounding(std::size_t k) const { return parts_->rounding[k]; }
const std::vector<std::uint8_t>& StoredGrid::hidden(bool cells) const { return parts_->hidden[cells]; }
double StoredGrid::time() const { return parts_->time; }
double StoredGrid::sphere() const { return parts_->sphere > 0 ? parts_->sphere : 0; }

void StoredGrid::load(const std::vector<ArrayInfo>& wanted) {
  Parts& parts = *parts_;
  if (parts.whole) return parts.load_whole(wanted);
  const GridDescription& about = parts.description;
  double points = 1;
  for (const std::size_t length : parts.points) points *= static_cast<double>(length);
  double numbers = 0;
  for (const ArrayInfo& array : wanted) numbers += points * static_cast<double>(array.components);
  if (parts.curved) numbers += 3 * points;
  if (numbers > most_numbers)
    throw GridFileError(
        fmt::format("{} has {:.3g} numbers; at most {:.3g} are read", parts.file.name(), numbers, most_numbers),
        "leave points out");
  double of_pieces = 0;  // points; more than those of the grid where pieces overlap
  for (const Piece& piece : about.pieces) of_pieces += static_cast<double>(parts.count(piece.extent, false));
  const double memory = 8 * (numbers + points) * std::max(1., of_pieces / points);
  if (memory > std::max(small_memory, most_memory_for_a_byte * static_cast<double>(parts.file.size())))
    throw GridFileError(
        fmt::format("{} claims to hold {:.3g} numbers in {} bytes", parts.file.name(), numbers, parts.file.size()),
        "if it is no damage but compression of equal numbers: save the file without a compressor");
  std::vector<std::size_t> read;  // arrays, masks among them
  const auto check_covered = [&](bool cells) {
    if (!about.covered(cells))
      throw GridFileError(fmt::format("the pieces of {} leave {} of its extent without values", parts.file.name(),
                                      cells ? "cells" : "points"),
                          "write the file again with all of its pieces");
  };
  parts.overlapping = about.pieces.size() > 1 && about.overlaps();
  check_covered(false);  // the coordinates come in pieces too
  bool cells_are_covered = false;
  for (std::size_t i = 0; i < about.arrays.size(); ++i) {
    const ArrayInfo& array = about.arrays[i];
    const bool is_wanted = std::any_of(wanted.begin(), wanted.end(), [&](const ArrayInfo& one) {
      return one.name == array.name && one.on_cells == array.on_cells;
    });
    const bool is_places = parts.curved && i + 1 == about.arrays.size();
    if (!is_wanted && !is_mask(array.name) && !is_places) continue;
    if (array.on_cells && !cells_are_covered) check_covered(true), cells_are_covered = true;
    read.push_back(i);
  }
  parts.check_lengths(read);
  parts.read_axes();
  parts.read_masks();
  for (const ArrayInfo& array : wanted) {
    const std::size_t i = *parts.find(array.name, array.on_cells);
    ArrayValues values{parts.whole_array(i), about.fill_values[i]};
    for (const char* name : {"_FillValue", "missing_value"})
      for (const std::string& key : {std::string(name), array.name + name})
        if (const double fill = parts.field_number(key); !std::isnan(fill)) values.fill_values.push_back(fill);
    parts.values.push_back(std::move(values));
  }
  parts.time = parts.field_number("TimeValue");
  parts.sphere = parts.field_number("sphere_radius");
}

}  // namespace gaussdrift::read
