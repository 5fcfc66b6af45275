// summary.json: what was chosen, what it cost, and what came out.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "gaussdrift/case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift::write {

/// The summary as JSON text, with the members of `more` at its end. Numbers that are not finite become null.
std::string summary_json(const Case& spec, const RunSummary& summary, const nlohmann::ordered_json& more);

}  // namespace gaussdrift::write
