// summary.png: the densities of a run side by side.
#pragma once

#include <filesystem>

#include "report/html.hpp"
#include "report/page.hpp"

namespace gaussdrift::report {

constexpr const char* summary_picture = "summary.png";

/// Initial, final, exact and error densities, and the tracks over the final one, from the files of the run. What is missing or fails is told in `result`.
void draw_summary(const std::filesystem::path& folder, const json& summary, ReportFiles& result);

}  // namespace gaussdrift::report
