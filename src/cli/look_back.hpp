// What is found out about a run beyond its numbers, from its last output: where its error comes from, what digits cost.
#pragma once

#include <functional>
#include <memory>
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

struct LookBack {
  std::optional<accuracy::Budget> measured{};
  nlohmann::ordered_json more = nlohmann::ordered_json::object();  // members of summary.json
  std::vector<std::string> warnings{};
};

/// The error budget, measured and predicted, and the table of tolerances. `run_seconds`: what the run took; seconds of
/// this go into `stages`. The run does not depend on it, so a failure is a warning.
LookBack look_back(const Case& spec, double run_seconds, const accuracy::LastFrame::Kept& last, StageTimes& stages,
                   int threads);

/// What is known of the last output.
struct LastOutput {
  accuracy::LastFrame::Kept kept{};
  std::optional<LookBack> seen{};  // where it was looked back on already, maybe by an earlier process
  bool too_many = false;           // its particles were not brought together
};

/// Keeps the last output. If steps come after it, it is looked back on at once, and a checkpoint has what was found.
/// may_gather: whether its particles may be brought together on one rank; asked at that output.
std::unique_ptr<Observer> keep_last_output(const Case& spec, LastOutput& last, int threads,
                                           std::function<bool()> may_gather);

}  // namespace gaussdrift::cli
