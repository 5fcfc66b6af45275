// Which effects go together. One list refuses cases, makes the table in docs/cases.md, and answers `explain
// effects`.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::input {

/// Two effects that do not go together, always or in some scenes.
struct EffectRule {
  std::string_view effect, other;  // the complaint stands at the first
  std::string_view unless;         // "the charge has a density of its own": when they go together all the same;
                                   // empty: never
  std::string_view reason;         // why not
  std::string_view remedy;
  bool (*apart)(const EffectsSpec& effects, int dimension);  // asked where a case names both
};

const std::vector<EffectRule>& effect_rules();

/// The effects of the registry, without "effects.": in its order.
std::vector<std::string> effect_names();

/// "charge goes with vortex; with reaction if the charge has a density of its own; ...".
std::string goes_with(std::string_view effect);

/// The table of all pairs, as docs/cases.md shows it.
std::string effects_markdown();

}  // namespace gaussdrift::input
