// The page that a run leaves: report.html, self-contained and offline, with report.json and summary.png beside it. It
// is made from the files of the run, so it can be made again.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::report {

struct ReportFiles {
  std::vector<std::filesystem::path> written;
  std::vector<std::string> left_out;  // what the run did not leave, or could not be read
  std::vector<std::string> failed;    // what could not be written, and why
};

/// The panel of initial, final, exact and error densities. `later`: there is no time to draw it now.
enum class Pictures { drawn, not_wanted, later };

/// From summary.json, provenance.json, run.toml, report.frames, density/ and images/ of a run's folder. If one file cannot
/// be written, the others still are. Throws FileError where the folder holds no run.
ReportFiles write_report(const std::filesystem::path& folder, Pictures pictures, const PageSpec& wish = {});

}  // namespace gaussdrift::report
