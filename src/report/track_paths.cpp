#include "report/track_paths.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "base/lies_in.hpp"
#include "base/number.hpp"
#include "base/seam.hpp"
#include "write/track_files.hpp"

namespace gaussdrift::report {

namespace fs = std::filesystem;

namespace {

struct Row {
  std::int64_t id = 0;
  render::Point place{};
};

/// "7,0.1,0.5,0.25,...": nothing where it is none.
std::optional<Row> row_in(std::string_view line) {
  std::array<std::string_view, 4> cells;
  for (std::string_view& cell : cells) {
    const std::size_t comma = line.find(',');
    if (comma == std::string_view::npos) return std::nullopt;
    cell = line.substr(0, comma);
    line.remove_prefix(comma + 1);
  }
  const auto id = base::read_number<std::int64_t>(cells[0]);
  const auto x = base::read_number<double>(cells[2]), y = base::read_number<double>(cells[3]);
  if (!id || !x || !y) return std::nullopt;
  return Row{*id, {*x, *y}};
}

/// Calls visit(row) for each row. False if it is no table of tracks.
template <class Visit>
bool each_row(const fs::path& file, const Visit& visit) {
  std::ifstream lines(file);
  std::string line;
  if (!std::getline(lines, line) || !line.starts_with("id,t,x,y,")) return false;
  for (std::size_t i = 0; std::getline(lines, line); ++i) {
    if (i % 65536 == 0) base::seam();
    if (const auto row = row_in(line)) visit(*row);
  }
  return true;
}

}  // namespace

std::vector<render::PlaneLine> track_paths(const fs::path& folder) {
  constexpr std::size_t most_tracks = 200, most_places = 1000;
  const fs::path file = folder / write::track_table_name;
  if (std::error_code error; !fs::is_regular_file(file, error) || !base::lies_in(file, folder)) return {};
  std::map<std::int64_t, std::size_t> rows;
  if (!each_row(file, [&](const Row& row) { ++rows[row.id]; }) || rows.empty()) return {};
  struct Path {
    std::size_t every = 1, seen = 0, rows = 0;
    render::PlaneLine line{};
  };
  std::map<std::int64_t, Path> chosen;
  const std::size_t every = (rows.size() + most_tracks - 1) / most_tracks;
  std::size_t number = 0;
  for (const auto& [id, count] : rows)
    if (number++ % every == 0) chosen[id] = {(count + most_places - 1) / most_places, 0, count, {}};
  each_row(file, [&](const Row& row) {
    const auto path = chosen.find(row.id);
    if (path == chosen.end()) return;
    Path& one = path->second;
    if (one.seen % one.every == 0 || one.seen + 1 == one.rows) one.line.push_back(row.place);
    ++one.seen;
  });
  std::vector<render::PlaneLine> lines;
  for (auto& [id, path] : chosen) lines.push_back(std::move(path.line));
  return lines;
}

}  // namespace gaussdrift::report
