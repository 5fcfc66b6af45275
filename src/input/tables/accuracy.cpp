// [accuracy]: how accurate a run has to be.
#include <fmt/format.h>

#include <algorithm>

#include "effect/catalogue.hpp"
#include "effect/tracer_reactions.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

Section accuracy_section() {
  return {
      Table{.name = "accuracy",
            .required = false,
            .meaning = "how accurate the run has to be, and whether its error is split by cause"},
      {{.name = "target",
        .type = Type::number,
        .range = {1e-9, 0.5},
        .meaning =
            "largest error allowed at the last output, relative to max |rho|. `run` and `check` then choose the "
            "cheapest settings that are predicted to reach it: particles.per_axis, overlap and cutoff, time.step "
            "and evaluate.tolerance. The option `--accuracy` does the same"},
       {.name = "budget",
        .type = Type::choice,
        .fallback = "auto",
        .choices = {"auto", "measured", "none"},
        .meaning =
            "whether the run measures how much of its error comes from time stepping, smoothing, quadrature and Gauss "
            "transform. This needs a reference. `auto` measures where that costs at most about a tenth of the run"}}};
}

void read_accuracy(Reader& in, Case& spec) {
  const auto& budgets = find_key("accuracy", "budget").choices;
  spec.accuracy.budget = static_cast<AccuracySpec::Budget>(
      std::find(budgets.begin(), budgets.end(), in.choice("accuracy", "budget")) - budgets.begin());
  const auto target = in.number("accuracy", "target");
  if (!target) return;
  spec.accuracy.target = target->number;
  const Entry* edges = in.find("domain", "edges");
  if (const Entry* written = in.find("accuracy", "target"); written && edges && spec.domain.has(Edge::open))
    in.diagnostics.error(written->value.place, "no settings can be chosen for a target with open edges",
                         "what leaves is not known to the prediction of the error; leave out accuracy.target");
  if (const Entry* written = in.find("accuracy", "target"); written && !spec.sources.empty())
    in.diagnostics.error(written->value.place, "no settings can be chosen for a target with [[source]]",
                         "the error is predicted for what is there at the start; leave out accuracy.target");
  if (const Entry* written = in.find("accuracy", "target"); written && tracers_react(spec))
    in.diagnostics.error(
        written->value.place, "no settings can be chosen for a target with reactions of named densities",
        "the error is predicted for densities that do not change each other; leave out accuracy.target");
  if (const Entry* written = in.find("accuracy", "target"); written && spec.domain.coast != AtCoast::refuse)
    in.diagnostics.error(written->value.place, "no settings can be chosen for a target with domain.coast",
                         "the error is predicted for flows without land; leave out accuracy.target");
  std::string without;
  for (const auto& [effect, values] : effects_of(spec.effects))
    if (without.empty() && effect->decay_rate.empty()) without = values.name;
  if (const Entry* written = in.find("accuracy", "target"); written && !without.empty())
    in.diagnostics.error(written->value.place,
                         fmt::format("no settings can be chosen for a target with [effects.{}]", without),
                         fmt::format("the error is predicted for {}; leave out accuracy.target", known_to_budgets()));
}

void write_accuracy(Writer& out, const AccuracySpec& accuracy) {
  out.table("accuracy");
  if (accuracy.target) out.entry("target", written(*accuracy.target));
  out.entry("budget", written_choice(find_key("accuracy", "budget"), accuracy.budget));
}

}  // namespace gaussdrift::input
