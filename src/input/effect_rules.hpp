// Which effects go together. It follows from their traits: a case is refused by them, the table in docs/cases.md is
// written from them, and `explain effects` answers from them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "effect/catalogue.hpp"

namespace gaussdrift::input {

/// Two effects that do not go together, always or in some scenes.
struct EffectRule {
  std::string effect, other;    // the complaint stands at the first
  Trait trait, trait_of_other;  // apart where both hold
  std::string reason;           // why not
  std::string remedy;

  /// "the charge has a density of its own": when they go together all the same; empty: never.
  std::string unless() const;
  bool apart(const EffectSpec& one, const EffectSpec& two, int dimension) const {
    return trait.of(one, dimension) && trait_of_other.of(two, dimension);
  }
};

/// Of all effects, pair by pair in the order of the catalogue.
std::vector<EffectRule> effect_rules();

/// The effects in their order.
std::vector<std::string> effect_names();

/// "charge goes with vortex; with reaction if the charge has a density of its own; ...".
std::string goes_with(std::string_view effect);

/// The table of all pairs, as docs/cases.md shows it.
std::string effects_markdown();

}  // namespace gaussdrift::input
