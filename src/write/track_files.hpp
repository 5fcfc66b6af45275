// The files of the tracks of a run, [output.tracks]: the table tracks.csv, which grows as the run goes, and what is made
// from it when the run has ended. A kind of these is one object. To add one: its source and its line in track_files.cpp.
// docs/data.md, "Tracks".
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"
#include "write/track_rows.hpp"

namespace gaussdrift::write {

constexpr const char* track_table_name = "tracks.csv";

/// What a file tells besides its rows.
struct TrackHeading {
  std::string title;       // of the case
  std::string time_units;  // "hours since 2020-01-03 00:00"; empty: not known
};

struct TrackFileKind {
  TrackFile about;
  std::string_view file;  // "tracks.vtp"
  void (*write)(const std::filesystem::path& file, const TrackTable& table, const TrackHeading& heading) = nullptr;
  std::string (*view)(std::string_view file) =
      nullptr;  // lines of view.py that show it; null: ParaView does not read it
};

/// In the order of docs/cases.md.
const std::vector<TrackFileKind>& track_files();

/// Throws std::out_of_range if no kind is called so.
const TrackFileKind& find_track_file(std::string_view name);

/// The names of all files of a case that is followed; none without tracks.
std::vector<std::string> track_file_names(const OutputSpec& output);

/// Writes the table as the run goes, and the others at its end. The case has tracks.
std::unique_ptr<Observer> track_writer(const std::filesystem::path& folder, const Case& spec);

}  // namespace gaussdrift::write

template <>
std::vector<gaussdrift::write::TrackFileKind>& gaussdrift::base::catalogue<gaussdrift::write::TrackFileKind>();
