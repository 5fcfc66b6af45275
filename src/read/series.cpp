// A .pvd: the files of a series, one a time.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "read/grid_file.hpp"
#include "read/xml_tree.hpp"

namespace gaussdrift::read {

std::vector<SeriesEntry> read_series(const std::filesystem::path& file, bool each_time_once) {
  FileBytes bytes(file);
  const std::string name = bytes.name();
  const XmlFile xml = read_xml(bytes);
  const Element* collection = xml.root.child("Collection");
  if (!collection)
    throw GridFileError(fmt::format("{} is not a ParaView series: it has no <Collection>", name),
                        "a .pvd lists one file a time: <DataSet timestep=\"0\" file=\"a.vti\"/>");
  std::vector<SeriesEntry> entries;
  bool timeless = false, descends = false;  // the outputs of a run that went backwards
  for (const Element& item : collection->children) {
    if (item.name != "DataSet") continue;
    const std::size_t line = item.line;
    const std::string place = line_of(bytes, item);
    const std::string* data = item.attribute("file");
    const std::string* stamp = item.attribute("timestep");
    if (!data || data->empty()) throw GridFileError(fmt::format("{}: this <DataSet> has no file", place));
    SeriesEntry entry;
    entry.file = file.parent_path() / *data;
    entry.line = line;
    if (stamp) {
      const auto time = base::read_number<double>(*stamp);
      if (!time || !std::isfinite(*time))
        throw GridFileError(
            fmt::format("{}: timestep = {} of {} is not a number", place, base::in_quotes(*stamp, 60), *data),
            stamp->find(',') != std::string::npos ? "write a point, not a comma: 1.5" : "");
      entry.time = *time;
    }
    if (!entries.empty() && (!stamp || timeless))
      throw GridFileError(fmt::format("{}:{}: {} has no timestep", name, stamp ? entries.back().line : line,
                                      stamp ? entries.back().file.filename().string() : *data),
                          "every file of a series of several has its own: timestep=\"0.5\"");
    timeless = !stamp;
    if (each_time_once && !entries.empty() && entry.time == entries.back().time)
      throw GridFileError(
          fmt::format("{}: {} and {} of line {} are both for t = {}", place, *data,
                      entries.back().file.filename().string(), entries.back().line, entry.time),
          "one file a time is read, because parts may overlap and disagree. Parts of one grid are put together in "
          "ParaView: open the series, apply the filter Resample To Image, save the data as .vti with all times. Of two "
          "whole "
          "snapshots duplicates = \"first\" or \"last\" takes one");
    if (entries.size() == 1) descends = entry.time < entries.front().time;
    if (!entries.empty() && (descends ? entry.time > entries.back().time : entry.time < entries.back().time))
      throw GridFileError(fmt::format("{}: the times of {} do not {}: {} after {}", place, name,
                                      descends ? "descend" : "ascend", entry.time, entries.back().time));
    entries.push_back(std::move(entry));
  }
  if (entries.empty())
    throw GridFileError(fmt::format("the series {} is empty", name),
                        "a .pvd lists one file a time: <DataSet timestep=\"0\" file=\"a.vti\"/>");
  if (descends) std::reverse(entries.begin(), entries.end());
  return entries;
}

}  // namespace gaussdrift::read
