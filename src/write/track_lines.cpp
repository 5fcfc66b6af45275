// Tracks as lines of ParaView: points are the rows of the table, a line is a track.
#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <limits>
#include <system_error>

#include "base/seam.hpp"
#include "write/atomic_file.hpp"
#include "write/draining.hpp"
#include "write/track_files.hpp"

namespace gaussdrift::write {

namespace {

/// An array of `components` numbers a row, of a table that is read twice: for the range and for the numbers.
template <class At>
void add_rows(Draining& out, const TrackTable& table, const ArrayHeading& heading, std::size_t components,
              const At& at) {
  ValueRange range;
  table.for_each_row([&](const TrackRow& row) {
    double square = 0;
    for (std::size_t c = 0; c < components; ++c) {
      const double value = at(row, c);
      square += value * value;
    }
    range.add(components == 1 ? at(row, 0) : std::sqrt(square));
  });
  begin_array(out.text, heading, "Float64", range);
  Base64Numbers numbers(out.text, table.rows() * components);
  table.for_each_row([&](const TrackRow& row) {
    for (std::size_t c = 0; c < components; ++c) numbers.put(at(row, c));
    out.some();
  });
  numbers.end();
  end_array(out.text, heading, components == 1 ? nullptr : &range);
}

void add_fields(Draining& out, const TrackTable& table) {
  add_rows(out, table, {8, "t"}, 1, [](const TrackRow& row, std::size_t) { return row.number(1); });
  std::size_t column = table.columns().first_of_fields();
  for (const auto& [name, components] : table.columns().fields) {
    const auto own = static_cast<std::size_t>(components);
    const std::size_t shown = own == 1 ? 1 : 3;  // ParaView knows vectors by their three components
    add_rows(out, table, {8, name, shown == 1 ? "" : " NumberOfComponents=\"3\""}, shown,
             [&](const TrackRow& row, std::size_t c) { return c < own ? row.number(column + c) : 0.0; });
    column += own;
  }
}

// A line of ParaView has two points at least; a track of one row is a vertex. Cells are numbered vertices first.
bool is_line(const TrackTable::Track& track) { return track.rows > 1; }

std::vector<TrackTable::Track> in_order_of_cells(std::vector<TrackTable::Track> tracks) {
  std::stable_partition(tracks.begin(), tracks.end(), [](const TrackTable::Track& track) { return !is_line(track); });
  return tracks;
}

/// The tracks that are lines, or those that are vertices.
void add_cells(Draining& out, const TrackTable& table, bool lines) {
  constexpr std::size_t elsewhere = static_cast<std::size_t>(-1);
  std::vector<std::size_t> first;  // of each track
  std::vector<std::int64_t> ends;
  std::size_t count = 0;
  for (const TrackTable::Track& track : table.tracks()) {
    first.push_back(is_line(track) == lines ? count : elsewhere);
    if (is_line(track) != lines) continue;
    count += track.rows;
    ends.push_back(static_cast<std::int64_t>(count));
  }
  std::vector<std::int64_t> rows(count);  // track after track
  std::int64_t number = 0;
  table.for_each_row([&](const TrackRow& row) {
    if (first[row.track] != elsewhere) rows[first[row.track] + row.place] = number;
    ++number;
  });
  const char* kind = lines ? "Lines" : "Verts";
  out.text += fmt::format("      <{}>\n", kind);
  add_array(out.text, {8, "connectivity"}, rows.size(), [&](std::size_t i) { return rows[i]; });
  add_array(out.text, {8, "offsets"}, ends.size(), [&](std::size_t i) { return ends[i]; });
  out.text += fmt::format("      </{}>\n", kind);
}

void add_no_cells(std::string& text, const char* kind) {
  text += fmt::format("      <{}>\n", kind);
  for (const char* name : {"connectivity", "offsets"})
    add_array(text, {8, name}, 0, [](std::size_t) { return std::int64_t{0}; });
  text += fmt::format("      </{}>\n", kind);
}

void write_lines(const std::filesystem::path& file, const TrackTable& table, const TrackHeading&) {
  write_atomically(file, [&](std::FILE* stream) {
    Draining out(stream);
    const std::vector<TrackTable::Track> tracks = in_order_of_cells(table.tracks());
    const auto lines = static_cast<std::size_t>(std::count_if(tracks.begin(), tracks.end(), is_line));
    out.text += fmt::format(
        "<?xml version=\"1.0\"?>\n"
        "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
        "  <PolyData>\n"
        "    <Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" NumberOfLines=\"{}\" NumberOfStrips=\"0\" "
        "NumberOfPolys=\"0\">\n      <PointData Scalars=\"t\">\n",
        table.rows(), tracks.size() - lines, lines);
    add_fields(out, table);
    out.text += "      </PointData>\n      <CellData>\n";
    add_array(out.text, {8, "id"}, tracks.size(), [&](std::size_t i) { return tracks[i].id; });
    add_array(out.text, {8, "end"}, tracks.size(), [&](std::size_t i) { return std::int64_t{tracks[i].end}; });
    out.text += "      </CellData>\n      <Points>\n";
    const auto d = static_cast<std::size_t>(table.columns().dimension);
    add_rows(out, table, {8, "Points", " NumberOfComponents=\"3\""}, 3,
             [&](const TrackRow& row, std::size_t k) { return k < d ? row.number(2 + k) : 0.0; });
    out.text += "      </Points>\n";
    for (const bool are_lines : {false, true}) add_cells(out, table, are_lines);
    for (const char* kind : {"Strips", "Polys"}) add_no_cells(out.text, kind);
    out.text += "    </Piece>\n  </PolyData>\n</VTKFile>\n";
    out.all();
  });
}

}  // namespace

namespace {

// The file is made when the run has ended.
std::string view(std::string_view file) {
  return fmt::format(
      "if os.path.exists(os.path.join(here, '{0}')):\n"
      "    tracks = XMLPolyDataReader(registrationName='tracks', FileName=[os.path.join(here, '{0}')])\n"
      "    lines = Show(tracks, view)\n"
      "    ColorBy(lines, None)\n"
      "    lines.DiffuseColor = [1.0, 1.0, 1.0]\n"
      "    lines.LineWidth = 2.0\n",
      file);
}

}  // namespace

TrackFileKind track_lines() {
  return {.about = {.name = "vtp", .meaning = "tracks.vtp, lines for ParaView", .by_default = true},
          .file = "tracks.vtp",
          .write = write_lines,
          .view = view};
}

}  // namespace gaussdrift::write
