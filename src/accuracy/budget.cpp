#include "accuracy/budget.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <variant>

#include "accuracy/causes.hpp"
#include "effect/catalogue.hpp"
#include "effect/tracer_reactions.hpp"
#include "field/gridded/grid_data.hpp"

namespace gaussdrift::accuracy {

std::string budget_not_covered(const Case& spec) {
  if (const std::string reason = beyond_budgets(spec.effects, spec.domain.dimension); !reason.empty()) return reason;
  if (spec.domain.has(Edge::open)) return "what leaves through open edges of the domain is not known to it";
  if (!spec.sources.empty()) return "what sources release is not known to it";
  if (tracers_react(spec)) return "how named densities change into each other is not known to it";
  if (spec.domain.coast != AtCoast::refuse) return "what a coast does to errors is not known to it";
  for (const VelocitySpec& part : spec.velocity)
    if (const auto* file = std::get_if<FileVelocitySpec>(&part); file && file->data->levels)
      return "the velocity is read on the way, and every path of an exact density would read it again";
  if (spec.output.times.empty()) return "there is no output";
  return "";
}

// One by one: a new one must not be forgotten here.
void pass(base::StateBytes& bytes, Budget& b) {
  bytes(b.time_stepping, b.smoothing, b.quadrature, b.transform, b.left_out, b.total, b.interpolation, b.dominates,
        b.advice, b.probes, b.outside, b.particles, b.lowest, b.highest, b.not_covered, b.too_dear);
}

void pass_noise(base::StateBytes& bytes, Budget& b) { bytes(b.noise, b.others, b.only_some); }

void LastFrame::frame(const Frame& frame) {
  if (frame.elapsed != last_) return;
  kept_.any = true;
  kept_.time = frame.elapsed;
  kept_.particles = *frame.particles;
  kept_.density = {.lattice = frame.density->lattice, .rho = frame.density->rho};
  if (frame.exact) kept_.exact = *frame.exact;
  kept_.numbers = frame.numbers;
}

std::vector<std::pair<double, std::string>> told_causes(const Budget& budget) {
  std::vector<std::pair<double, std::string>> told;
  for (const Cause& cause : causes) {
    const double error = budget.*cause.error;
    if (!is_told(budget, cause)) continue;
    if (cause.error == &Budget::left_out && error <= 0) continue;  // most cases leave nothing out
    told.emplace_back(error, cause.name);
  }
  return told;
}

std::string to_text(const Budget& budget) {
  std::string text;
  for (const auto& [error, name] : told_causes(budget))
    text += fmt::format("  {:<17} {:<8.2g}{}\n", name, error, budget.dominates == name ? " <- dominates" : "");
  if (budget.interpolation > 0)
    text += fmt::format("  {:<17} {:<8.2g} of the data, which the exact density does not know\n", "interpolation",
                        budget.interpolation);
  for (const std::string& advice : budget.advice) text += fmt::format("hint   {}\n", advice);
  return text;
}

nlohmann::ordered_json to_json(const Budget& budget) {
  if (!budget.known()) return {{"not_covered", budget.not_covered}};
  auto json = nlohmann::ordered_json::object();
  for (const Cause& cause : causes)
    if (is_told(budget, cause)) json[cause.key] = budget.*cause.error;
  if (!budget.only_some || budget.total > 0) json["total"] = budget.total;
  if (budget.interpolation > 0) json["interpolation"] = budget.interpolation;
  json["dominates"] = budget.dominates;
  if (!budget.only_some) json["probes"] = budget.probes;
  json["advice"] = budget.advice;
  return json;
}

}  // namespace gaussdrift::accuracy
