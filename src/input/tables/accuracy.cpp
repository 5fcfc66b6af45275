// [accuracy]: how accurate a run has to be.
#include <fmt/format.h>

#include <algorithm>

#include "effect/catalogue.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

void read_accuracy(Reader& in, Case& scene) {
  const auto& budgets = find_key("accuracy", "budget").choices;
  scene.accuracy.budget = static_cast<AccuracySpec::Budget>(
      std::find(budgets.begin(), budgets.end(), in.choice("accuracy", "budget")) - budgets.begin());
  const auto target = in.number("accuracy", "target");
  if (!target) return;
  scene.accuracy.target = target->number;
  std::string without;
  for (const auto& [effect, spec] : effects_of(scene.effects))
    if (without.empty() && effect->decay_rate.empty()) without = spec.name;
  if (const Entry* written = in.find("accuracy", "target"); written && !without.empty())
    in.diagnostics.error(written->value.place,
                         fmt::format("no settings can be chosen for a target with [effects.{}]", without),
                         "the error is predicted for transport and reaction; leave out accuracy.target");
}

}  // namespace gaussdrift::input
