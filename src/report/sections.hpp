// The sections of the page about a run, each from the summary of the run, summary.json.
#pragma once

#include <filesystem>
#include <string>

#include "report/html.hpp"

namespace gaussdrift::report {

/// "72 (2020-01-06 00:00)"
std::string time_of(const json& frame, const char* format = "{:.4g}");

/// What the case calls the density. It is a stranger's word.
std::string label_of(const json& summary);

/// How right the run is and what would help, in one sentence; then the error at the end and at its worst, the target, the
/// checks, the advice.
std::string verdict(const json& summary);

/// How the errors were measured, as far as a reader would otherwise guess wrongly.
std::string about_comparison(const json& summary, const json& last);

/// Norms of the error over time on a logarithmic axis, as SVG; empty for a single output.
std::string error_curves(const json& frames);

/// Where the error comes from.
std::string budget_table(const json& budget);

/// What digits of the sum cost.
std::string accuracy_table(const json& summary);

/// How many particles there are, and what the lattice points without one would have carried.
std::string particles(const json& summary);

/// What the seconds went into, and what the effects did.
std::string seconds(const json& summary);

/// Mass, centroid and extremes over time.
std::string conservation(const json& frames);

std::string checks_table(const json& checks);

std::string how_to_make_again(const json& provenance);

/// Links to the files that the run has left in its folder. Empty where there are none.
std::string linked_files(const std::filesystem::path& folder);

}  // namespace gaussdrift::report
