#include "read/grid_file.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <vtkCallbackCommand.h>
#include <vtkCellData.h>
#include <vtkDataArray.h>
#include <vtkDataSet.h>
#include <vtkFieldData.h>
#include <vtkImageData.h>
#include <vtkMatrix3x3.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkRectilinearGrid.h>
#include <vtkSmartPointer.h>
#include <vtkVersion.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLImageDataReader.h>
#include <vtkXMLRectilinearGridReader.h>
#include <vtkXMLUtilities.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include "base/text_file.hpp"

namespace gaussdrift::read {

namespace {

constexpr double most_numbers = 268435456;  // 2 GiB
// Before a file is opened: the same numbers as text, three times as long, and a line for each of a million times.
constexpr double largest_data_file = 3 * 8 * most_numbers, largest_series_file = 2e8;

std::string name_of(const std::filesystem::path& file) { return file.filename().string(); }

void check_readable(const std::filesystem::path& file, const std::string& context) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw GridFileError(fmt::format("there is no file {}{}", file.string(), context),
                        "paths are relative to the folder of the case file");
  if (const std::string other = base::what_else_it_is(file); !other.empty())
    throw GridFileError(fmt::format("{}{} is {}, not a file of data", file.string(), context, other));
  if (!std::filesystem::is_regular_file(file, error))
    throw GridFileError(fmt::format("{}{} is a pipe", file.string(), context),
                        "data on a grid are read several times: write them to a file");
  if (!std::ifstream(file, std::ios::binary))
    throw GridFileError(fmt::format("the file {}{} cannot be read", file.string(), context));
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  const double most = file.extension() == ".pvd" ? largest_series_file : largest_data_file;
  if (!error && static_cast<double>(bytes) > most)
    throw GridFileError(fmt::format("{}{} has {:.3g} MB; at most {:.3g} MB are read", file.string(), context,
                                    static_cast<double>(bytes) / 1e6, most / 1e6),
                        "leave times or points out");
}

/// VTK's complaints instead of lines on stderr.
class Complaints {
 public:
  explicit Complaints(vtkObject* source) {
    command_->SetClientData(this);
    command_->SetCallback([](vtkObject*, unsigned long, void* self, void* text) {
      static_cast<Complaints*>(self)->any_ = true;
      (void)text;
    });
    source->AddObserver(vtkCommand::ErrorEvent, command_);
    source->AddObserver(vtkCommand::WarningEvent, command_);
  }
  bool any() const { return any_; }

 private:
  vtkNew<vtkCallbackCommand> command_;
  bool any_ = false;
};

std::vector<SeriesEntry> series(const std::filesystem::path& file) {
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(file.string().c_str()));
  vtkXMLDataElement* collection = root ? root->FindNestedElementWithName("Collection") : nullptr;
  if (!collection)
    throw GridFileError(fmt::format("{} is not a ParaView series: it has no <Collection>", name_of(file)));
  std::vector<SeriesEntry> entries;
  for (int k = 0; k < collection->GetNumberOfNestedElements(); ++k) {
    vtkXMLDataElement* item = collection->GetNestedElement(k);
    if (std::string(item->GetName()) != "DataSet") continue;
    const char* name = item->GetAttribute("file");
    const char* stamp = item->GetAttribute("timestep");
    SeriesEntry entry;
    const std::string text = stamp ? stamp : "0";
    const auto read = std::from_chars(text.data(), text.data() + text.size(), entry.time);
    if (!name || read.ec != std::errc() || !std::isfinite(entry.time))
      throw GridFileError(fmt::format("entry {} of {} has no file or no time", k + 1, name_of(file)));
    entry.file = file.parent_path() / name;
    if (!entries.empty() && entry.time <= entries.back().time)
      throw GridFileError(
          fmt::format("the times of {} do not ascend: {} after {}", name_of(file), entry.time, entries.back().time));
    entries.push_back(entry);
  }
  if (entries.empty()) throw GridFileError(fmt::format("the series {} is empty", name_of(file)));
  return entries;
}

struct Grid {
  std::array<std::vector<double>, max_dimension> axis;
  vtkSmartPointer<vtkDataSet> data;
};

template <class Reader>
vtkSmartPointer<vtkDataSet> updated(const std::filesystem::path& file) {
  vtkNew<Reader> reader;
  const Complaints complaints(reader);
  reader->SetFileName(file.string().c_str());
  if (!reader->CanReadFile(file.string().c_str()))
    throw GridFileError(fmt::format("{} is not a file of the kind that its name says", name_of(file)));
  reader->Update();
  if (complaints.any() || reader->GetErrorCode() != 0)
    throw GridFileError(fmt::format("{} is damaged: VTK cannot read it to its end", name_of(file)));
  return reader->GetOutput();
}

Grid read_one(const std::filesystem::path& file) {
  const std::string kind = file.extension().string();
  Grid grid;
  if (kind == ".vti") {
    grid.data = updated<vtkXMLImageDataReader>(file);
    auto* image = vtkImageData::SafeDownCast(grid.data);
    const double *origin = image->GetOrigin(), *spacing = image->GetSpacing();
    const int* extent = image->GetExtent();
    const auto* turned = image->GetDirectionMatrix();
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        if (turned->GetElement(i, j) != (i == j ? 1 : 0))
          throw GridFileError(fmt::format("the image {} is turned against the axes", name_of(file)));
    for (int k = 0; k < 3; ++k)
      for (int i = extent[2 * k]; i <= extent[2 * k + 1]; ++i) grid.axis[k].push_back(origin[k] + spacing[k] * i);
  } else if (kind == ".vtr") {
    grid.data = updated<vtkXMLRectilinearGridReader>(file);
    auto* rectilinear = vtkRectilinearGrid::SafeDownCast(grid.data);
    vtkDataArray* coordinates[] = {rectilinear->GetXCoordinates(), rectilinear->GetYCoordinates(),
                                   rectilinear->GetZCoordinates()};
    for (int k = 0; k < 3; ++k)
      for (vtkIdType i = 0; coordinates[k] && i < coordinates[k]->GetNumberOfTuples(); ++i)
        grid.axis[k].push_back(coordinates[k]->GetComponent(i, 0));
  } else {
    throw GridFileError(fmt::format("{} has the ending \"{}\"", name_of(file), kind),
                        "known files: .vti (image data), .vtr (rectilinear grid), .pvd (a series of these)");
  }
  for (const auto& axis : grid.axis)
    for (std::size_t i = 0; i < axis.size(); ++i)
      if (!std::isfinite(axis[i]) || (i > 0 && axis[i] <= axis[i - 1]))
        throw GridFileError(fmt::format("the coordinates of {} do not ascend", name_of(file)));
  return grid;
}

void check_shape(const Grid& grid, const std::filesystem::path& file, int dimension) {
  const auto& axis = grid.axis;
  const bool flat = axis[2].size() <= 1;
  if (axis[0].size() < 2 || axis[1].size() < 2 || (dimension == 3 && flat) || (dimension == 2 && !flat))
    throw GridFileError(fmt::format("the grid of {} has {} x {} x {} points, but the domain has {} dimensions",
                                    name_of(file), axis[0].size(), axis[1].size(), axis[2].size(), dimension),
                        dimension == 2 ? "a 2D grid has 1 point along z" : "a 3D grid has at least 2 points an axis");
}

vtkDataArray* find_array(vtkDataSet* data, const std::filesystem::path& file, const std::string& name) {
  vtkPointData* fields = data->GetPointData();
  std::vector<std::string> known;
  for (int k = 0; k < fields->GetNumberOfArrays(); ++k)
    if (fields->GetArrayName(k)) known.push_back(fmt::format("\"{}\"", fields->GetArrayName(k)));
  if (name.empty() && fields->GetNumberOfArrays() == 1 && fields->GetArray(0)) return fields->GetArray(0);
  const std::string list = known.empty() ? "it has no point data" : fmt::format("it has {}", fmt::join(known, ", "));
  if (name.empty())
    throw GridFileError(
        fmt::format("{} does not have exactly one array; say which one is meant: {}", name_of(file), list),
        "array = \"...\"");
  if (vtkDataArray* found = fields->GetArray(name.c_str())) return found;
  if (data->GetCellData()->HasArray(name.c_str()))
    throw GridFileError(fmt::format("the array \"{}\" of {} belongs to cells, not to points", name, name_of(file)),
                        "ParaView's filter Cell Data to Point Data makes point data of it");
  throw GridFileError(fmt::format("{} has no array \"{}\"; {}", name_of(file), name, list));
}

void check_count(vtkDataArray* values, std::size_t points, const std::filesystem::path& file,
                 const std::string& array) {
  if (static_cast<std::size_t>(values->GetNumberOfTuples()) != points)
    throw GridFileError(fmt::format("{} is damaged: the array \"{}\" has {} values for {} points", name_of(file), array,
                                    values->GetNumberOfTuples(), points));
}

}  // namespace

std::string vtk_version() { return vtkVersion::GetVTKVersion(); }

std::vector<SeriesEntry> read_series(const std::filesystem::path& file) {
  check_readable(file, "");
  return series(file);
}

GridSnapshot read_snapshot(const std::filesystem::path& file, const std::string& array) {
  check_readable(file, "");
  const Grid grid = read_one(file);
  GridSnapshot result;
  const int dimension = result.dimension = grid.axis[2].size() > 1 ? 3 : 2;
  check_shape(grid, file, dimension);
  vtkDataArray* values = find_array(grid.data, file, array);
  std::size_t points = 1;
  for (int k = 0; k < dimension; ++k) {
    result.axis[k] = grid.axis[k];
    points *= grid.axis[k].size();
  }
  if (values->GetNumberOfComponents() != 1)
    throw GridFileError(fmt::format("the array \"{}\" of {} has {} components, needed: 1", array, name_of(file),
                                    values->GetNumberOfComponents()));
  check_count(values, points, file, array);
  result.values.resize(points);
  for (std::size_t i = 0; i < points; ++i) result.values[i] = values->GetComponent(static_cast<vtkIdType>(i), 0);
  if (vtkDataArray* stamp = grid.data->GetFieldData()->GetArray("TimeValue");
      stamp && stamp->GetNumberOfTuples() > 0 && std::isfinite(stamp->GetComponent(0, 0)))
    result.time = stamp->GetComponent(0, 0);
  return result;
}

std::shared_ptr<const GridData> read_grid(const std::filesystem::path& file, const std::string& array, int dimension,
                                          std::size_t least_components, std::size_t most_components) {
  check_readable(file, "");
  const bool is_series = file.extension() == ".pvd";
  const std::vector<SeriesEntry> entries = is_series ? series(file) : std::vector<SeriesEntry>{{file, 0}};
  auto result = std::make_shared<GridData>();
  result->dimension = dimension;
  for (const SeriesEntry& entry : entries) {
    check_readable(entry.file, is_series ? fmt::format(", of the series {}", name_of(file)) : "");
    const Grid grid = read_one(entry.file);
    check_shape(grid, entry.file, dimension);
    vtkDataArray* values = find_array(grid.data, entry.file, array);
    const auto components = static_cast<std::size_t>(values->GetNumberOfComponents());
    if (components < least_components || components > most_components)
      throw GridFileError(fmt::format(
          "the array \"{}\" of {} has {} component{}, needed: {}", values->GetName() ? values->GetName() : "",
          name_of(entry.file), components, components == 1 ? "" : "s",
          least_components == most_components ? fmt::format("{}", least_components)
                                              : fmt::format("{} or {}", least_components, most_components)));
    if (result->times.empty()) {
      result->name = fmt::format("{} of {}", values->GetName() ? values->GetName() : "the array", name_of(file));
      result->components = components;
      for (int k = 0; k < dimension; ++k) result->axis[k] = grid.axis[k];
      const double numbers = static_cast<double>(result->points()) * double(components) * double(entries.size());
      if (numbers > most_numbers)
        throw GridFileError(fmt::format("{} holds {:.3g} numbers at {} times; at most {:.3g} are read", name_of(file),
                                        numbers, entries.size(), most_numbers),
                            "leave times or points out");
    }
    for (int k = 0; k < dimension; ++k)
      if (grid.axis[k] != result->axis[k] || components != result->components)
        throw GridFileError(
            fmt::format("the grid of {} differs from that of {}", name_of(entry.file), name_of(entries.front().file)),
            "all times of a series share one grid");
    std::vector<double> numbers(result->points() * components);
    check_count(values, result->points(), entry.file, array);
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] = values->GetComponent(static_cast<vtkIdType>(i / components), static_cast<int>(i % components));
      if (std::isfinite(numbers[i])) continue;
      std::vector<double> place;
      std::size_t rest = i / components;
      for (int k = 0; k < dimension; ++k) {
        place.push_back(result->axis[k][rest % result->axis[k].size()]);
        rest /= result->axis[k].size();
      }
      throw GridFileError(
          fmt::format("{} is {} at ({}) in {}", result->name, numbers[i], fmt::join(place, ", "), name_of(entry.file)),
          "every value must be finite");
    }
    result->times.push_back(entry.time);
    result->values.push_back(std::move(numbers));
  }
  return result;
}

}  // namespace gaussdrift::read
