#include "read/written_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <map>

#include "base/lies_in.hpp"
#include "gaussdrift/error.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift::read {

namespace fs = std::filesystem;

namespace {

/// "density_0012.vti": 12. More than 9999 outputs have longer numbers, so names do not sort as numbers do.
std::optional<std::size_t> number_of(const fs::path& file) {
  const std::string stem = file.stem().string();
  const char *first = stem.data() + stem.rfind('_') + 1, *last = stem.data() + stem.size();
  std::size_t number = 0;
  const auto read = std::from_chars(first, last, number);
  const fs::path kind = file.extension();
  if ((kind != ".vti" && kind != ".pvti") || read.ec != std::errc() || read.ptr != last) return std::nullopt;
  return number;
}

/// A run has its files in its folder. What leads elsewhere was put there by somebody.
void refuse_links_out(const fs::path& folder, const fs::path& file) {
  if (!base::lies_in(file, folder))
    throw FileError(
        fmt::format("{} is a link out of the folder of the run, or lies behind one, and such links are not followed; "
                    "put the file itself there, or name the file that you want to read",
                    file.string()));
}

std::optional<double> time_in(const fs::path& file) { return StoredDensity(file, "rho").time(); }

}  // namespace

std::vector<WrittenOutput> written_outputs(const fs::path& place, std::string_view series) {
  if (!fs::exists(place)) throw FileError(fmt::format("there is no {}", place.string()));
  if (!fs::is_directory(place)) return {{place, time_in(place), number_of(place).value_or(0)}};
  std::vector<WrittenOutput> outputs;
  const fs::path folder = place / series;
  if (fs::is_directory(folder))
    for (const auto& entry : fs::directory_iterator(folder))
      if (const auto number = number_of(entry.path())) outputs.push_back({entry.path(), {}, *number});
  for (const WrittenOutput& output : outputs) refuse_links_out(place, output.file);
  std::sort(outputs.begin(), outputs.end(),
            [](const WrittenOutput& a, const WrittenOutput& b) { return a.number < b.number; });
  std::vector<read::SeriesEntry> listed;
  try {
    if (const fs::path list = place / fmt::format("{}.pvd", series); fs::exists(list)) {
      refuse_links_out(place, list);
      listed = read::read_series(list);
    }
  } catch (const read::GridFileError&) {  // the files say it themselves
  }
  std::map<fs::path, double> times;  // by name
  for (const read::SeriesEntry& entry : listed) {
    // A run names files of its own. What leads elsewhere was put there by somebody.
    const fs::path inside = entry.file.lexically_normal().lexically_relative((place / "").lexically_normal());
    if (inside.empty() || *inside.begin() == "..")
      throw FileError(fmt::format("line {} of {}.pvd in {} names {}, which is not in the folder of the run", entry.line,
                                  series, place.string(), entry.file.string()));
    times[entry.file.filename()] = entry.time;
  }
  // One of another run may have been left, with pieces or without.
  for (std::size_t i = 1; i < outputs.size(); ++i)
    if (outputs[i].number == outputs[i - 1].number) {
      const bool first_is_listed = times.count(outputs[i - 1].file.filename()) > 0;
      outputs.erase(outputs.begin() + static_cast<std::ptrdiff_t>(first_is_listed ? i : i - 1));
      --i;
    }
  for (WrittenOutput& output : outputs) {
    const auto known = times.find(output.file.filename());
    output.time = known != times.end() ? known->second : time_in(output.file);
  }
  return outputs;
}

}  // namespace gaussdrift::read
