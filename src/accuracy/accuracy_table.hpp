// What digits of the sum cost: the Gauss transform of the last output of a run, done again to several tolerances.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "accuracy/budget.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/simulation.hpp"

namespace gaussdrift::accuracy {

/// {"accuracy_table": rows of tolerance, error, milliseconds}, with "accuracy_table_note" where a time is null because
/// it cannot be trusted; or {"accuracy_table_left_out": why}. It is a luxury: about a tenth of the run, or half a
/// second, is spent.
nlohmann::ordered_json accuracy_table(const Case& spec, double run_seconds, const LastFrame::Kept& last, int threads);

}  // namespace gaussdrift::accuracy
