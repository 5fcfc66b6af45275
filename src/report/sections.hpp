// The sections of the page about a run, each from the summary of the run, summary.json.
#pragma once

#include <string>

#include "report/html.hpp"

namespace gaussdrift::report {

/// The error at the end and at its worst, the target, the checks, in a few sentences.
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

}  // namespace gaussdrift::report
