// A .pvd: the files of a series, one a time.
#include <fmt/format.h>
#include <vtkSmartPointer.h>
#include <vtkXMLDataElement.h>
#include <vtkXMLUtilities.h>

#include <cmath>
#include <string_view>

#include "base/number.hpp"
#include "read/grid_file.hpp"
#include "read/vtk_description.hpp"

namespace gaussdrift::read {

std::vector<SeriesEntry> read_series(const std::filesystem::path& file) {
  check_readable(file);
  const std::string name = file.filename().string();
  const auto root =
      vtkSmartPointer<vtkXMLDataElement>::Take(vtkXMLUtilities::ReadElementFromFile(file.string().c_str()));
  vtkXMLDataElement* collection = root ? root->FindNestedElementWithName("Collection") : nullptr;
  if (!collection)
    throw GridFileError(fmt::format("{} is not a ParaView series: it has no <Collection>", name),
                        "a .pvd lists one file a time: <DataSet timestep=\"0\" file=\"a.vti\"/>");
  std::vector<SeriesEntry> entries;
  LineCounter lines(file);
  bool timeless = false;
  for (int k = 0; k < collection->GetNumberOfNestedElements(); ++k) {
    vtkXMLDataElement* item = collection->GetNestedElement(k);
    if (std::string_view(item->GetName()) != "DataSet") continue;
    const std::size_t line = lines.line(item);
    const std::string place = fmt::format("{}:{}", name, line);
    const char* data = item->GetAttribute("file");
    const char* stamp = item->GetAttribute("timestep");
    if (!data || !*data) throw GridFileError(fmt::format("{}: this <DataSet> has no file", place));
    SeriesEntry entry;
    entry.file = file.parent_path() / data;
    entry.line = line;
    if (stamp) {
      const auto time = base::read_number<double>(stamp);
      if (!time || !std::isfinite(*time))
        throw GridFileError(
            fmt::format("{}: timestep = \"{}\" of {} is not a number", place, stamp, data),
            std::string_view(stamp).find(',') != std::string_view::npos ? "write a point, not a comma: 1.5" : "");
      entry.time = *time;
    }
    if (!entries.empty() && (!stamp || timeless))
      throw GridFileError(fmt::format("{}:{}: {} has no timestep", name, stamp ? entries.back().line : line,
                                      stamp ? entries.back().file.filename().string() : data),
                          "every file of a series of several has its own: timestep=\"0.5\"");
    timeless = !stamp;
    if (!entries.empty() && entry.time == entries.back().time)
      throw GridFileError(
          fmt::format("{}: {} and {} of line {} are both for t = {}", place, data,
                      entries.back().file.filename().string(), entries.back().line, entry.time),
          "one file a time is read, because parts may overlap and disagree. Parts of one grid are put together in "
          "ParaView: open the series, apply the filter Resample To Image, save the data as .vti with all times");
    if (!entries.empty() && entry.time < entries.back().time)
      throw GridFileError(
          fmt::format("{}: the times of {} do not ascend: {} after {}", place, name, entry.time, entries.back().time));
    entries.push_back(std::move(entry));
  }
  if (entries.empty())
    throw GridFileError(fmt::format("the series {} is empty", name),
                        "a .pvd lists one file a time: <DataSet timestep=\"0\" file=\"a.vti\"/>");
  return entries;
}

}  // namespace gaussdrift::read
