#include "write/track_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "base/seam.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::write {

namespace {

constexpr const char* axes[] = {"x", "y", "z"};

/// "u", or one name a component.
std::vector<std::string> names_of(const std::string& field, int components, int dimension) {
  if (components == 1) return {field};
  std::vector<std::string> names;
  for (int c = 0; c < components; ++c)
    names.push_back(components == dimension ? fmt::format("{}_{}", field, axes[c])
                                            : fmt::format("{}_{}{}", field, axes[c / dimension], axes[c % dimension]));
  return names;
}

[[noreturn]] void fail(const std::filesystem::path& file, const std::string& what) {
  throw FileError(fmt::format("{} {}", file.string(), what));
}

}  // namespace

std::string TrackColumns::heading() const {
  std::string text = "id,t";
  for (int k = 0; k < dimension; ++k) text += fmt::format(",{}", axes[k]);
  for (const auto& [field, components] : fields)
    for (const std::string& name : names_of(field, components, dimension)) text += "," + name;
  return text + ",end\n";
}

std::string track_rows_text(const TrackSamples& samples) {
  std::string text;
  const auto d = static_cast<std::size_t>(samples.dimension);
  const std::size_t width = samples.components();
  for (std::size_t i = 0; i < samples.size(); ++i) {
    text += fmt::format("{},{}", samples.id[i], samples.time[i]);
    for (std::size_t k = 0; k < d; ++k) text += fmt::format(",{}", samples.place[i * d + k]);
    for (std::size_t c = 0; c < width; ++c) {
      const double value = samples.values[i * width + c];
      text += std::isnan(value) ? ",nan" : fmt::format(",{}", value);
    }
    text += ",";
    if (samples.end[i] > 0) text += samples.reasons[static_cast<std::size_t>(samples.end[i] - 1)];
    text += "\n";
  }
  return text;
}

double TrackRow::number(std::size_t column) const {
  const std::string_view cell = cells_[column];
  if (cell == "nan") return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  std::from_chars(cell.data(), cell.data() + cell.size(), value);
  return value;
}

void TrackTable::scan(const std::function<void(TrackRow& row)>& visit) const {
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file_.c_str(), "rb"), std::fclose);
  if (!stream) fail(file_, "cannot be read");
  const std::string heading = columns_.heading();
  const auto columns = static_cast<std::size_t>(std::count(heading.begin(), heading.end(), ',')) + 1;
  std::string text;
  std::size_t line = 0;
  TrackRow row;
  const auto take = [&](std::string_view of_line) {
    if (line++ == 0) {
      if (std::string(of_line) + "\n" != heading) fail(file_, "has other columns than those that this run writes");
      return;
    }
    row.cells_.clear();
    for (std::size_t first = 0; first <= of_line.size();) {
      const std::size_t comma = std::min(of_line.find(',', first), of_line.size());
      row.cells_.push_back(of_line.substr(first, comma - first));
      first = comma + 1;
    }
    const std::string_view id = row.cells_.front();
    if (row.cells_.size() != columns ||
        std::from_chars(id.data(), id.data() + id.size(), row.id).ptr != id.data() + id.size())
      fail(file_, fmt::format("has been changed: its line {} is no row of this run", line));
    visit(row);
  };
  constexpr std::size_t most = 1 << 20;
  for (bool more = true; more;) {
    base::seam();
    const std::size_t before = text.size();
    text.resize(before + most);
    const std::size_t read = std::fread(text.data() + before, 1, most, stream.get());
    if (read < most && std::ferror(stream.get())) fail(file_, "cannot be read");
    more = read == most;
    text.resize(before + read);
    std::size_t first = 0;
    for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', first)) {
      take(std::string_view(text).substr(first, end - first));
      first = end + 1;
    }
    text.erase(0, first);
  }
  if (!text.empty()) fail(file_, "ends within a row");
}

TrackTable::TrackTable(std::filesystem::path file, TrackColumns columns)
    : file_(std::move(file)), columns_(std::move(columns)) {
  std::map<std::int64_t, Track> by_id;
  scan([&](TrackRow& row) {
    Track& track = by_id[row.id];
    track.id = row.id;
    ++track.rows;
    if (!row.end().empty()) {
      const auto reason = std::find(columns_.reasons.begin(), columns_.reasons.end(), row.end());
      track.end = 1 + static_cast<int>(reason - columns_.reasons.begin());
    }
    ++rows_;
  });
  for (const auto& [id, track] : by_id) tracks_.push_back(track);
}

void TrackTable::for_each_row(const std::function<void(const TrackRow& row)>& visit) const {
  std::vector<std::size_t> places(tracks_.size(), 0);
  scan([&](TrackRow& row) {
    const auto track = std::lower_bound(tracks_.begin(), tracks_.end(), row.id,
                                        [](const Track& one, std::int64_t id) { return one.id < id; });
    if (track == tracks_.end() || track->id != row.id) fail(file_, "has been changed while it was read");
    row.track = static_cast<std::size_t>(track - tracks_.begin());
    row.place = places[row.track]++;
    visit(row);
  });
}

}  // namespace gaussdrift::write
