// Tracks as NetCDF: trajectories of the CF conventions, section H.4.4 (an indexed ragged array), so that rows stay in the
// order of the run. The format is the classic one with 64-bit offsets, which every reader knows; no library is needed to
// write it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cerrno>
#include <cstdint>
#include <limits>
#include <string>
#include <system_error>
#include <utility>
#include <variant>
#include <vector>

#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/track_files.hpp"

namespace gaussdrift::write {

namespace {

enum NetcdfType : std::uint32_t { of_letters = 2, of_int = 4, of_double = 6 };
enum NetcdfTag : std::uint32_t { of_dimensions = 10, of_variables = 11, of_attributes = 12 };

std::uint64_t size_of(NetcdfType type) { return type == of_double ? 8 : 4; }

/// Numbers as the format has them: the largest byte first.
template <class Number>
void put(std::string& text, Number number) {
  for (int byte = sizeof number - 1; byte >= 0; --byte) text += static_cast<char>(number >> (8 * byte) & 0xff);
}
void put(std::string& text, double number) { put(text, std::bit_cast<std::uint64_t>(number)); }
void put(std::string& text, NetcdfType type, double number) {
  if (type == of_double)
    put(text, number);
  else
    put(text, static_cast<std::uint32_t>(static_cast<std::int32_t>(number)));
}
/// Letters behind their number, filled up to a multiple of four.
void put_letters(std::string& text, const std::string& letters) {
  put(text, static_cast<std::uint32_t>(letters.size()));
  text += letters;
  text.append((4 - letters.size() % 4) % 4, '\0');
}

using Attributes = std::vector<std::pair<std::string, std::variant<std::string, std::vector<int>>>>;

void put_attributes(std::string& text, const Attributes& attributes) {
  put(text, attributes.empty() ? std::uint32_t{0} : std::uint32_t{of_attributes});
  put(text, static_cast<std::uint32_t>(attributes.size()));
  for (const auto& [name, value] : attributes) {
    put_letters(text, name);
    if (const auto* letters = std::get_if<std::string>(&value)) {
      put(text, std::uint32_t{of_letters});
      put_letters(text, *letters);
      continue;
    }
    const auto& numbers = std::get<std::vector<int>>(value);
    put(text, std::uint32_t{of_int});
    put(text, static_cast<std::uint32_t>(numbers.size()));
    for (const int number : numbers) put(text, of_int, number);
  }
}

/// A variable with a number for each track, or for each row.
struct Variable {
  std::string name;
  NetcdfType type = of_double;
  bool of_rows = true;
  Attributes attributes;
};

/// All of a file but its numbers. Those of tracks come first, variable after variable, then those of rows, row after row.
std::string heading_text(const std::vector<Variable>& variables, const Attributes& attributes, std::size_t tracks,
                         std::size_t rows) {
  const auto with_offset = [&](std::uint64_t begin) {
    std::string text = {'C', 'D', 'F', 2};
    put(text, static_cast<std::uint32_t>(rows));
    put(text, std::uint32_t{of_dimensions});
    put(text, std::uint32_t{2});
    put_letters(text, "trajectory");
    put(text, static_cast<std::uint32_t>(tracks));
    put_letters(text, "obs");
    put(text, std::uint32_t{0});  // it grows
    put_attributes(text, attributes);
    put(text, std::uint32_t{of_variables});
    put(text, static_cast<std::uint32_t>(variables.size()));
    for (const Variable& variable : variables) {
      put_letters(text, variable.name);
      put(text, std::uint32_t{1});
      put(text, std::uint32_t{variable.of_rows});  // the number of its dimension
      put_attributes(text, variable.attributes);
      put(text, std::uint32_t{variable.type});
      const std::uint64_t size = size_of(variable.type) * (variable.of_rows ? 1 : tracks);
      put(text, static_cast<std::uint32_t>(std::min<std::uint64_t>(size, 0xffffffffu)));
      put(text, begin);
      begin += size;
    }
    return text;
  };
  return with_offset(with_offset(0).size());
}

constexpr std::array<const char*, 3> axis_names{"x", "y", "z"}, axis_attributes{"X", "Y", "Z"};

std::vector<Variable> variables_of_tracks(const TrackTable& table) {
  const std::vector<TrackTable::Track>& tracks = table.tracks();
  const bool narrow = std::all_of(tracks.begin(), tracks.end(), [](const TrackTable::Track& track) {
    return track.id <= std::numeric_limits<int>::max() && track.id >= std::numeric_limits<int>::min();
  });
  std::vector<int> values{0};
  std::string meanings = "it_goes_on_to_the_end";
  for (const std::string& reason : table.columns().reasons) {
    meanings += " " + reason;
    values.push_back(static_cast<int>(values.size()));
  }
  return {{"trajectory",
           narrow ? of_int : of_double,  // the format has no wider whole numbers
           false,
           {{"cf_role", "trajectory_id"}, {"long_name", "id of the particle"}}},
          {"end",
           of_int,
           false,
           {{"long_name", "why the track ends"}, {"flag_values", values}, {"flag_meanings", meanings}}}};
}

/// The first is the number of the track; the others are the columns of the table from t on.
std::vector<Variable> variables_of_rows(const TrackColumns& columns, const TrackHeading& heading) {
  std::string coordinates = "time";
  for (std::size_t k = 0; k < static_cast<std::size_t>(columns.dimension); ++k)
    coordinates += fmt::format(" {}", axis_names[k]);
  const bool clock = !heading.time_units.empty();
  std::vector<Variable> variables{
      {"trajectory_index",
       of_int,
       true,
       {{"long_name", "the trajectory that this row belongs to"}, {"instance_dimension", "trajectory"}}},
      {"time",
       of_double,
       true,
       {{"standard_name", "time"},
        {"axis", "T"},
        {"units", clock ? heading.time_units : "1"},
        {"long_name", clock ? "time" : "time of the scene, which has no clock of the world"}}}};
  for (std::size_t k = 0; k < static_cast<std::size_t>(columns.dimension); ++k)
    variables.push_back(
        {axis_names[k],
         of_double,
         true,
         {{"axis", axis_attributes[k]}, {"long_name", fmt::format("{} of the particle", axis_names[k])}}});
  for (const auto& [name, components] : columns.fields)
    for (std::size_t c = 0; c < static_cast<std::size_t>(components); ++c)
      variables.push_back({components == 1 ? name : fmt::format("{}_{}", name, axis_names[c]),
                           of_double,
                           true,
                           {{"coordinates", coordinates}}});
  return variables;
}

void write_netcdf(const std::filesystem::path& file, const TrackTable& table, const TrackHeading& heading) {
  if (table.rows() > static_cast<std::size_t>(std::numeric_limits<std::int32_t>::max()))
    throw FileError(fmt::format("cannot write {}: the tracks have {} rows, and the format counts to 2^31",
                                file.string(), table.rows()));
  std::vector<Variable> variables = variables_of_tracks(table);
  const NetcdfType type_of_id = variables.front().type;
  for (Variable& variable : variables_of_rows(table.columns(), heading)) variables.push_back(std::move(variable));
  const std::size_t columns = variables.size() - 3;  // of doubles
  Attributes attributes{{"Conventions", "CF-1.8"}, {"featureType", "trajectory"}};
  if (!heading.title.empty()) attributes.emplace_back("title", heading.title);
  attributes.emplace_back("source", "gaussdrift");
  write_atomically(file, [&](std::FILE* stream) {
    std::string text = heading_text(variables, attributes, table.tracks().size(), table.rows());
    const auto write_out = [&] {
      if (std::fwrite(text.data(), 1, text.size(), stream) != text.size())
        throw std::system_error(errno, std::generic_category());
      text.clear();
    };
    for (const TrackTable::Track& track : table.tracks()) put(text, type_of_id, static_cast<double>(track.id));
    for (const TrackTable::Track& track : table.tracks()) put(text, of_int, track.end);
    table.for_each_row([&](const TrackRow& row) {
      put(text, static_cast<std::uint32_t>(row.track));
      for (std::size_t c = 0; c < columns; ++c) put(text, row.number(1 + c));
      if (text.size() > (1 << 20)) write_out();
    });
    write_out();
  });
}

}  // namespace

TrackFileKind track_netcdf() {
  return {.about = {.name = "netcdf", .meaning = "tracks.nc, trajectories of the CF conventions"},
          .file = "tracks.nc",
          .write = write_netcdf};
}

}  // namespace gaussdrift::write
