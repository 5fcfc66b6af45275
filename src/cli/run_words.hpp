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

}  // namespace gaussdrift::cli
