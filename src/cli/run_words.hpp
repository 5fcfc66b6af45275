// What a finished run says in its last lines and warnings.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "accuracy/budget.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift::cli {

/// What was done, what came out, how wrong it is and why, and where to look. `target`: the accuracy that was asked for.
std::string ending_text(const Case& spec, const RunSummary& summary, const std::optional<accuracy::Budget>& budget,
                        std::optional<double> target, const std::filesystem::path& folder);

/// Warnings: facts that the results do not show by themselves. For the terminal, the page and the log.
std::vector<std::string> warnings_of(const Case& spec, const RunSummary& summary);

}  // namespace gaussdrift::cli
