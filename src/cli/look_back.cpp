#include "cli/look_back.hpp"

#include <fmt/format.h>

#include <new>

#include "accuracy/accuracy_table.hpp"
#include "base/stopwatch.hpp"
#include "sim/grid_pieces.hpp"

namespace gaussdrift::cli {

namespace {

bool budgeted(const Case& spec) {
  return spec.accuracy.budget != AccuracySpec::Budget::none && spec.reference.kind != ReferenceSpec::Kind::none;
}

}  // namespace

bool looks_back(const Case& spec) {
  // It needs the density as a whole.
  if (pieces_of_grid(spec).count() > 1) return false;
  return (budgeted(spec) && accuracy::budget_not_covered(spec).empty()) || spec.output.report;
}

std::optional<accuracy::Budget> look_back(const Case& spec, RunSummary& summary, const accuracy::LastFrame::Kept& last,
                                          nlohmann::ordered_json& more, std::vector<std::string>& warnings,
                                          int threads) {
  const auto stage = [&](const char* name, const auto& work) {
    const base::Stopwatch watch;
    try {
      work();
    } catch (const std::bad_alloc&) {
      warnings.push_back(fmt::format("no {}: out of memory", name));
    } catch (const std::exception& error) {
      warnings.push_back(fmt::format("no {}: {}", name, error.what()));
    }
    const double seconds = watch.seconds();
    summary.stages.add(name, seconds);
    summary.seconds += seconds;
  };
  std::optional<accuracy::Budget> measured, predicted;
  if (budgeted(spec)) {
    const auto effort = spec.accuracy.budget == AccuracySpec::Budget::measured ? accuracy::Effort::whatever
                                                                               : accuracy::Effort::share_of_run;
    stage("error budget",
          [&] { measured = accuracy::measure_budget(spec, make_scene(spec, threads), last, effort, threads); });
    stage("predicted error budget",
          [&] { predicted = accuracy::predict_budget(spec, make_scene(spec, threads), effort, threads); });
  }
  if (measured && predicted)
    more["budget"] = {{"norm", "largest error at the last output, relative to the largest exact density there"},
                      {"predicted", accuracy::to_json(*predicted)},
                      {"measured", accuracy::to_json(*measured)},
                      {"advice", measured->advice}};
  if (spec.output.report)
    stage("accuracy table", [&] { more.update(accuracy::accuracy_table(spec, summary, last, threads)); });
  return measured;
}

}  // namespace gaussdrift::cli
