// The part of the page that plays the run: markup, scripts and the frames themselves.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gaussdrift/case.hpp"
#include "report/html.hpp"
#include "report/reel.hpp"

namespace gaussdrift::report {

struct PageFile {
  std::string_view name;   // "page.css"
  std::string_view bytes;  // as it stands in src/report/page/
};

/// Generated from src/report/page/ by cmake/EmbedFiles.cmake.
const std::vector<PageFile>& page_files();

/// Throws std::out_of_range if no file is called so.
std::string page_file(std::string_view name);

/// The frames that a run left, report.frames. None where there is no such file. Throws FileError for a damaged one.
std::optional<Reel> kept_reel(const std::filesystem::path& folder);

/// The same, or those that its density files show. None where there are neither; `notes`
/// is told why.
std::optional<Reel> reel_of_run(const std::filesystem::path& folder, const PageSpec& wish,
                                std::vector<std::string>& notes);

/// `summary`: of the run, for its words.
std::string player_section(const Reel& reel, const json& summary);

}  // namespace gaussdrift::report
