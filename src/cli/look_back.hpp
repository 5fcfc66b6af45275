// What is found out about a finished run beyond its numbers: where its error comes from, what digits cost.
#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/budget.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift::cli {

/// Does looking back need the last output?
bool looks_back(const Case& spec);

/// The error budget, measured and predicted, and the table of tolerances: into `more`, for summary.json, their seconds
/// into the summary. The run does not depend on it, so a failure is a warning.
std::optional<accuracy::Budget> look_back(const Case& spec, RunSummary& summary, const accuracy::LastFrame::Kept& last,
                                          nlohmann::ordered_json& more, std::vector<std::string>& warnings,
                                          int threads);

}  // namespace gaussdrift::cli
