// summary.png: the densities of a run side by side.
#pragma once

#include <filesystem>
#include <string>

#include "report/html.hpp"
#include "report/page.hpp"

namespace gaussdrift::report {

constexpr const char* summary_picture = "summary.png";

/// Initial, middle, final, exact and error densities and the change between the first and the last, from the files of the
/// run, or from the frames of its page where it wrote none; where something is. What is missing or fails is told in
/// `result`. Returns what to say about the part that is shown; empty: all of the domain.
std::string draw_summary(const std::filesystem::path& folder, const json& summary, ReportFiles& result);

}  // namespace gaussdrift::report
