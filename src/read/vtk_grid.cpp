#include "read/vtk_grid.hpp"

#include <fmt/format.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataArraySelection.h>
#include <vtkDataSet.h>
#include <vtkExecutive.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkObjectFactory.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLDataParser.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLRectilinearGridReader.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <optional>
#include <stdexcept>
#include <string_view>

#include "read/grid_file_error.hpp"
#include "read/vtk_description.hpp"

namespace gaussdrift::read {

namespace {

std::string name_of(const std::filesystem::path& file) { return file.filename().string(); }

/// VTK's complaints, which it would else print.
class Complaints {
 public:
  Complaints() {
    command_->SetClientData(this);
    command_->SetCallback(
        [](vtkObject*, unsigned long, void* self, void*) { static_cast<Complaints*>(self)->any_ = true; });
  }
  void listen_to(vtkObject* source) {
    source->AddObserver(vtkCommand::ErrorEvent, command_);
    source->AddObserver(vtkCommand::WarningEvent, command_);
  }
  vtkCallbackCommand* command() { return command_; }
  bool any() const { return any_; }

 private:
  vtkNew<vtkCallbackCommand> command_;
  bool any_ = false;
};

/// VTK's name for the type of a DataArray.
std::optional<int> word_type(std::string_view type) {
  static constexpr std::pair<std::string_view, int> types[] = {
      {"Float32", VTK_FLOAT},    {"Float64", VTK_DOUBLE},     {"Int8", VTK_TYPE_INT8},   {"UInt8", VTK_TYPE_UINT8},
      {"Int16", VTK_TYPE_INT16}, {"UInt16", VTK_TYPE_UINT16}, {"Int32", VTK_TYPE_INT32}, {"UInt32", VTK_TYPE_UINT32},
      {"Int64", VTK_TYPE_INT64}, {"UInt64", VTK_TYPE_UINT64}};
  for (const auto& [name, value] : types)
    if (name == type) return value;
  return std::nullopt;
}

/// The checks that are added to VTK's reader. Exceptions must not pass through VTK, so errors are kept.
class Checks {
 public:
  const std::filesystem::path* file = nullptr;
  bool loading = false;  // and not only looking at the description
  std::optional<Description> description;
  std::optional<GridFileError> error;

  template <class Work>
  int kept(const Work& work) {
    try {
      return work();
    } catch (const GridFileError& found) {
      if (!error) error = found;
      return 0;
    }
  }
};

template <class Base>
class CheckedReader : public Base, public Checks {
 public:
  static CheckedReader* New() { VTK_STANDARD_NEW_BODY(CheckedReader); }

  std::array<vtkDataArraySelection*, 2> selections() {
    return {this->PointDataArraySelection, this->CellDataArraySelection};
  }

 protected:
  int ReadPrimaryElement(vtkXMLDataElement* grid) override {
    return kept([&] {
      description = describe_grid(grid, *file, std::is_same_v<Base, vtkXMLImageDataReader>);
      return Base::ReadPrimaryElement(grid);
    });
  }

  // VTK reads text up to the first word that it does not understand.
  int ReadArrayValues(vtkXMLDataElement* item, vtkIdType first_of_array, vtkAbstractArray* array, vtkIdType first,
                      vtkIdType count, vtkXMLReader::FieldType type) override {
    auto* numbers = vtkDataArray::SafeDownCast(array);
    if (!numbers || !is_text(item)) return Base::ReadArrayValues(item, first_of_array, array, first, count, type);
    return kept([&] {
      const std::vector<double>& values = text(item);
      if (first + count > static_cast<vtkIdType>(values.size())) fail(item, "fewer", first + count);
      const int components = numbers->GetNumberOfComponents();
      const int type_of_words = numbers->GetDataType();
      const bool whole = type_of_words != VTK_FLOAT && type_of_words != VTK_DOUBLE;
      // Text may be a little above the largest number of Float32, as 3.4028235e38 is. The largest whole numbers of 64
      // bits are no doubles.
      constexpr double largest = std::numeric_limits<float>::max(), rounding = 1 + 3e-8,
                       largest_whole = 0x1.fffffffffffffp+62;
      for (vtkIdType i = 0; i < count; ++i) {
        double value = values[static_cast<std::size_t>(first + i)];
        if (whole ? !(value == std::floor(value) && value >= numbers->GetDataTypeMin() &&
                      value <= numbers->GetDataTypeMax())
                  : type_of_words == VTK_FLOAT && std::isfinite(value) && std::abs(value) > largest * rounding)
          throw GridFileError(fmt::format("{}: {} in the array \"{}\" is no number of its type {}",
                                          line_of(*file, item), value, name_in(item), item->GetAttribute("type")));
        if (type_of_words == VTK_FLOAT && std::isfinite(value)) value = std::clamp(value, -largest, largest);
        if (whole) value = std::min(value, largest_whole);
        const vtkIdType at = first_of_array + i;
        numbers->SetComponent(at / components, static_cast<int>(at % components), value);
      }
      return 1;
    });
  }

  // Checks the numbers of one piece. VTK takes as many as it needs and does not report those that are left. Then the
  // extent is wrong, or a number has a comma.
  int ReadPieceData() override {
    if (!Base::ReadPieceData()) return 0;
    return kept([&] {
      const int* extent = this->PieceExtents + 6 * static_cast<std::ptrdiff_t>(this->Piece);
      for (const bool cells : {false, true}) {
        vtkXMLDataElement* home = cells ? this->CellDataElements[this->Piece] : this->PointDataElements[this->Piece];
        std::size_t count = 1;
        for (int k = 0; k < 3; ++k) {
          const bool thin = cells && description->extent[2 * k] < description->extent[2 * k + 1];
          count *= static_cast<std::size_t>(extent[2 * k + 1] - extent[2 * k] + (thin ? 0 : 1));
        }
        for (int i = 0; home && i < home->GetNumberOfNestedElements(); ++i) {
          vtkXMLDataElement* item = home->GetNestedElement(i);
          if (cells ? !this->CellDataArrayIsEnabled(item) : !this->PointDataArrayIsEnabled(item)) continue;
          int components = 1;
          item->GetScalarAttribute("NumberOfComponents", components);
          check_length(item, count * static_cast<std::size_t>(components));
        }
      }
      if constexpr (std::is_same_v<Base, vtkXMLRectilinearGridReader>) {
        vtkXMLDataElement* home = this->CoordinateElements[this->Piece];
        for (int k = 0; home && k < std::min(3, home->GetNumberOfNestedElements()); ++k)
          check_length(home->GetNestedElement(k), static_cast<std::size_t>(extent[2 * k + 1] - extent[2 * k] + 1));
      }
      return 1;
    });
  }

 private:
  static const char* name_in(vtkXMLDataElement* item) {
    const char* name = item->GetAttribute("Name");
    return name ? name : "";
  }

  static bool is_text(vtkXMLDataElement* item) {
    const char* format = item->GetAttribute("format");
    return !item->GetAttribute("offset") && !(format && std::string_view(format) == "binary");
  }

  /// Kept, for pieces of a grid are read row by row.
  const std::vector<double>& text(vtkXMLDataElement* item) {
    if (item != text_of_) text_ = numbers_in_text(*file, item), text_of_ = item;
    return text_;
  }

  [[noreturn]] void fail(vtkXMLDataElement* item, const char* more_or_fewer, vtkIdType count) const {
    throw GridFileError(fmt::format("{}: the array \"{}\" has {} numbers than the {} that the extent needs",
                                    line_of(*file, item), name_in(item), more_or_fewer, count));
  }

  void check_length(vtkXMLDataElement* item, std::size_t count) {
    const auto type = word_type(item->GetAttribute("type") ? item->GetAttribute("type") : "");
    if (!type || count == 0) return;
    std::array<double, 2> numbers{};  // more than two words of any type
    std::size_t found = 0;            // of two, beginning with the last one that is needed
    if (is_text(item))
      found = text(item).size() - (count - 1);
    else if (vtkTypeInt64 offset = 0; item->GetAttribute("offset") && item->GetScalarAttribute("offset", offset))
      found = this->XMLParser->ReadAppendedData(offset, numbers.data(), count - 1, 2, *type);
    else
      found = this->XMLParser->ReadInlineData(item, 0, numbers.data(), count - 1, 2, *type);
    if (found != 1) fail(item, found > 1 ? "more" : "fewer", static_cast<vtkIdType>(count));
  }

  vtkXMLDataElement* text_of_ = nullptr;
  std::vector<double> text_;
};

bool is_mask(const std::string& name) {
  return name == "vtkGhostType" || name == "vtkGhostLevels" || name == "vtkValidPointMask";
}

}  // namespace

struct VtkGrid::Parts {
  std::filesystem::path file;
  Complaints complaints;
  vtkSmartPointer<vtkXMLStructuredDataReader> reader;
  Checks* checks = nullptr;  // of the reader
  std::array<vtkDataArraySelection*, 2> selections{};
  vtkSmartPointer<vtkDataSet> data;
  std::array<std::size_t, 3> points{};
  std::vector<ArrayInfo> arrays;
  std::vector<ArrayValues> values;
  std::array<std::vector<double>, 3> axis;
  std::array<double, 3> rounding{};
  double time = 0;
  std::array<std::vector<std::uint8_t>, 2> hidden;  // points, cells

  template <class Reader>
  void open() {
    vtkSmartPointer<Reader> checked = vtkSmartPointer<Reader>::Take(Reader::New());
    complaints.listen_to(checked);
    complaints.listen_to(checked->GetExecutive());
    checked->SetParserErrorObserver(complaints.command());
    checked->file = &file;
    checked->SetFileName(file.string().c_str());
    checks = checked;
    selections = checked->selections();
    reader = checked;
    run([&] {
      if (!reader->CanReadFile(file.string().c_str()))
        throw GridFileError(fmt::format("{} is not a file of the kind that its name says", name_of(file)));
      reader->UpdateInformation();
    });
  }

  /// VTK's work, with what came of it. Lengths that are nonsense end in exceptions of the library.
  template <class Work>
  void run(const Work& work) const {
    try {
      work();
    } catch (const std::length_error&) {
      throw GridFileError(fmt::format("{} is damaged: its lengths are impossible", name_of(file)));
    } catch (const std::bad_alloc&) {
      throw GridFileError(fmt::format("{} is damaged, or too large for the memory", name_of(file)));
    }
    check();
  }

  void check() const {
    if (checks->error) throw *checks->error;
    if (complaints.any() || reader->GetErrorCode() != 0 || !checks->description)
      throw GridFileError(fmt::format("{} is damaged: VTK cannot read it to its end", name_of(file)));
  }

  const Description& description() const { return *checks->description; }

  /// The array of points or cells; it has as many numbers as they are.
  vtkDataArray* found(const std::string& name, bool cells) const {
    vtkDataSetAttributes* home = cells ? static_cast<vtkDataSetAttributes*>(data->GetCellData()) : data->GetPointData();
    vtkDataArray* array = home->GetArray(name.c_str());
    const vtkIdType count = cells ? data->GetNumberOfCells() : data->GetNumberOfPoints();
    if (array && array->GetNumberOfTuples() != count)
      throw GridFileError(fmt::format("{} is damaged: the array \"{}\" has {} values for {} {}", name_of(file), name,
                                      array->GetNumberOfTuples(), count, cells ? "cells" : "points"));
    return array;
  }

  /// The number of a field array that has one; NaN if there is no such array.
  double field_number(const std::string& name) const {
    vtkDataArray* array = data->GetFieldData()->GetArray(name.c_str());
    return array && array->GetNumberOfTuples() > 0 ? array->GetComponent(0, 0)
                                                   : std::numeric_limits<double>::quiet_NaN();
  }

  void read_axes() {
    const Description& about = description();
    for (std::size_t k = 0; k < 3; ++k) {
      const int first = about.extent[2 * k];
      if (auto* rectilinear = vtkRectilinearGrid::SafeDownCast(data)) {
        vtkDataArray* coordinates = k == 0   ? rectilinear->GetXCoordinates()
                                    : k == 1 ? rectilinear->GetYCoordinates()
                                             : rectilinear->GetZCoordinates();
        if (!coordinates || static_cast<std::size_t>(coordinates->GetNumberOfTuples()) != points[k])
          throw GridFileError(fmt::format("{} has no coordinates along {}", name_of(file), "xyz"[k]));
        double largest = 0;
        for (std::size_t i = 0; i < points[k]; ++i) {
          axis[k].push_back(coordinates->GetComponent(static_cast<vtkIdType>(i), 0));
          largest = std::max(largest, std::abs(axis[k].back()));
        }
        if (coordinates->GetDataType() == VTK_FLOAT)  // a few roundings: spacings may have been added up
          rounding[k] = 4 * double(std::numeric_limits<float>::epsilon()) * largest;
      } else {
        for (std::size_t i = 0; i < points[k]; ++i)
          axis[k].push_back(about.origin[k] + about.spacing[k] * (first + static_cast<double>(i)));
        const double farthest = std::max(std::abs(double(first)), std::abs(double(about.extent[2 * k + 1])));
        rounding[k] = about.origin_rounding[k] + about.spacing_rounding[k] * farthest;
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
            fmt::format("the {} coordinate of point {} of {} is {}", "xyz"[k], i + 1, name_of(file), x[i]));
      if (i > 0 && (descends ? !(x[i] < x[i - 1]) : !(x[i] > x[i - 1])))
        throw GridFileError(
            fmt::format("the {} coordinates of {} neither ascend nor descend: {} comes after {} at point {}", "xyz"[k],
                        name_of(file), x[i], x[i - 1], i + 1));
    }
  }

  void read_masks() {
    constexpr int hidden_point = 2, hidden_cell = 32;  // vtkDataSetAttributes
    for (const bool cells : {false, true}) {
      auto& mask = hidden[cells];
      const auto hide = [&](const char* name, const auto& is_hidden) {
        vtkDataArray* array = found(name, cells);
        if (!array) return;
        mask.resize(static_cast<std::size_t>(array->GetNumberOfTuples()));
        for (std::size_t i = 0; i < mask.size(); ++i)
          mask[i] = mask[i] || is_hidden(static_cast<int>(array->GetComponent(static_cast<vtkIdType>(i), 0)));
      };
      hide("vtkGhostType", [&](int flags) { return (flags & (cells ? hidden_cell : hidden_point)) != 0; });
      if (!cells) hide("vtkValidPointMask", [](int valid) { return valid == 0; });
    }
    if (!hidden[1].empty()) hide_points_of_hidden_cells();
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

VtkGrid::VtkGrid(const std::filesystem::path& file) : parts_(std::make_unique<Parts>()) {
  parts_->file = file;
  if (file.extension() == ".vti")
    parts_->open<CheckedReader<vtkXMLImageDataReader>>();
  else
    parts_->open<CheckedReader<vtkXMLRectilinearGridReader>>();
  const Description& about = parts_->description();
  double count = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    parts_->points[k] = static_cast<std::size_t>(about.extent[2 * k + 1] - about.extent[2 * k]) + 1;
    count *= static_cast<double>(parts_->points[k]);
  }
  if (count > most_numbers)
    throw GridFileError(
        fmt::format("{} has {:.3g} points; at most {:.3g} numbers are read", name_of(file), count, most_numbers),
        "leave points out");
  for (const ArrayInfo& array : about.arrays)
    if (!is_mask(array.name)) parts_->arrays.push_back(array);
}

VtkGrid::~VtkGrid() = default;

const std::array<std::size_t, 3>& VtkGrid::points() const { return parts_->points; }
const std::vector<ArrayInfo>& VtkGrid::arrays() const { return parts_->arrays; }
const std::vector<ArrayValues>& VtkGrid::values() const { return parts_->values; }
const std::vector<double>& VtkGrid::axis(std::size_t k) const { return parts_->axis[k]; }
double VtkGrid::rounding(std::size_t k) const { return parts_->rounding[k]; }
const std::vector<std::uint8_t>& VtkGrid::hidden(bool cells) const { return parts_->hidden[cells]; }

void VtkGrid::load(const std::vector<ArrayInfo>& wanted) {
  Parts& parts = *parts_;
  const Description& about = parts.description();
  double numbers = 0, points = 1;
  for (const std::size_t length : parts.points) points *= static_cast<double>(length);
  for (const ArrayInfo& array : wanted) numbers += points * static_cast<double>(array.components);
  if (numbers > most_numbers)
    throw GridFileError(
        fmt::format("{} has {:.3g} numbers; at most {:.3g} are read", name_of(parts.file), numbers, most_numbers),
        "leave points out");
  const auto check_covered = [&](bool cells) {
    if (!about.covered(cells))
      throw GridFileError(fmt::format("the pieces of {} leave {} of its extent without values", name_of(parts.file),
                                      cells ? "cells" : "points"),
                          "write the file again with all of its pieces");
  };
  check_covered(false);  // the coordinates come in pieces too
  for (const bool cells : {false, true}) {
    vtkDataArraySelection* selection = parts.selections[cells];
    selection->DisableAllArrays();
    for (const ArrayInfo& array : about.arrays) {
      const bool is_wanted = std::any_of(wanted.begin(), wanted.end(), [&](const ArrayInfo& one) {
        return one.name == array.name && one.on_cells == array.on_cells;
      });
      if (array.on_cells != cells || (!is_wanted && !is_mask(array.name))) continue;
      check_covered(cells);
      selection->EnableArray(array.name.c_str());
    }
  }
  parts.run([&] { parts.reader->Update(); });
  parts.data = parts.reader->GetOutputAsDataSet();
  parts.read_axes();
  parts.read_masks();
  for (const ArrayInfo& array : wanted) {
    vtkDataArray* found = parts.found(array.name, array.on_cells);
    if (!found || static_cast<std::size_t>(found->GetNumberOfComponents()) != array.components)
      throw GridFileError(fmt::format("the array \"{}\" of {} does not hold numbers", array.name, name_of(parts.file)));
    ArrayValues values;
    values.numbers.resize(static_cast<std::size_t>(found->GetNumberOfTuples()) * array.components);
    for (std::size_t i = 0; i < values.numbers.size(); ++i)
      values.numbers[i] =
          found->GetComponent(static_cast<vtkIdType>(i / array.components), static_cast<int>(i % array.components));
    for (std::size_t i = 0; i < about.arrays.size(); ++i)
      if (about.arrays[i].name == array.name && about.arrays[i].on_cells == array.on_cells)
        values.fill_values = about.fill_values[i];
    for (const char* name : {"_FillValue", "missing_value"})
      for (const std::string& key : {std::string(name), array.name + name})
        if (const double fill = parts.field_number(key); !std::isnan(fill)) values.fill_values.push_back(fill);
    parts.values.push_back(std::move(values));
  }
  parts.time = parts.field_number("TimeValue");
  parts.data = nullptr;  // they are many bytes
  parts.checks = nullptr;
  parts.reader = nullptr;
}

double VtkGrid::time() const { return parts_->time; }

}  // namespace gaussdrift::read
