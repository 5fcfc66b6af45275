#include "input/effect_rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace gaussdrift::input {
namespace {

/// Two traits that do not go together in one scene, and why, in their words.
struct Meeting {
  Trait (*one)(const EffectTraits& traits);
  Trait EffectTraits::*other;
  const char* reason;  // {0}: the words of the one, {1}: of the other
};

Trait interacting(const EffectTraits& traits) { return {.words = traits.particles_interact ? "move each other" : ""}; }
Trait moved_by_weights(const EffectTraits& traits) { return traits.moved_by_weights; }
Trait carrying_more(const EffectTraits& traits) { return traits.carries_more; }
Trait replacing(const EffectTraits& traits) { return traits.replaces_particles; }

constexpr Meeting meetings[] = {
    {moved_by_weights, &EffectTraits::grows_weights, "{1}, and {0}"},
    {interacting, &EffectTraits::adds_particles, "{1}, and they cannot be carried from the start"},
    {carrying_more, &EffectTraits::replaces_particles, "{1}, which have weights but no {0}"},
    {interacting, &EffectTraits::makes_ellipses, "{1}, and only of round ones it is known how they {0}"},
    {replacing, &EffectTraits::makes_ellipses, "{1}, and {0}, whose weights would take up the spread of round blobs"},
    {replacing, &EffectTraits::scatters, "{1}, and {0}, on nodes that take from their neighbours what lies in order"},
};

EffectRule rule_of(const NamedEffect& one, const NamedEffect& two, const Trait& trait, const Trait& other,
                   std::string reason) {
  const std::string_view remedy = !trait.remedy.empty() ? trait.remedy : other.remedy;
  return {std::string(one.about.name),
          std::string(two.about.name),
          trait,
          other,
          std::move(reason),
          std::string(remedy.empty() ? "leave out one of them" : remedy)};
}

/// The rules about a pair, whichever of the two is named first.
std::vector<EffectRule> rules_of(std::string_view one, std::string_view two) {
  std::vector<EffectRule> found;
  for (const EffectRule& rule : effect_rules())
    if ((rule.effect == one && rule.other == two) || (rule.effect == two && rule.other == one)) found.push_back(rule);
  return found;
}

/// "yes", "no", or "if ...".
std::string verdict(std::string_view one, std::string_view two) {
  std::vector<std::string> conditions;
  for (const EffectRule& rule : rules_of(one, two)) {
    if (rule.unless().empty()) return "no";
    conditions.push_back(rule.unless());
  }
  return conditions.empty() ? "yes" : fmt::format("if {}", fmt::join(conditions, " and "));
}

}  // namespace

std::string EffectRule::unless() const {
  if (trait.unless.empty() || trait_of_other.unless.empty())
    return std::string(trait.unless.empty() ? trait_of_other.unless : trait.unless);
  return fmt::format("{} or {}", trait.unless, trait_of_other.unless);
}

std::vector<EffectRule> effect_rules() {
  std::vector<EffectRule> rules;
  for (const NamedEffect& one : effects())
    for (const NamedEffect& two : effects()) {
      if (&one == &two) continue;
      for (const Meeting& meeting : meetings) {
        const Trait trait = meeting.one(one.traits), other = two.traits.*meeting.other;
        if (!trait.words.empty() && !other.words.empty())
          rules.push_back(
              rule_of(one, two, trait, other, fmt::format(fmt::runtime(meeting.reason), trait.words, other.words)));
      }
      const Trait &blind = one.traits.blind_to_widths, &widens = two.traits.widens_blobs;
      if (!blind.words.empty() && !widens.words.empty())
        rules.push_back(rule_of(one, two, blind, widens, std::string(blind.words)));
    }
  return rules;
}

std::vector<std::string> effect_names() {
  std::vector<std::string> names;
  for (const NamedEffect& effect : effects()) names.emplace_back(effect.about.name);
  return names;
}

std::string goes_with(std::string_view effect) {
  std::vector<std::string> always, sometimes;
  for (const std::string& other : effect_names()) {
    if (other == effect) continue;
    const std::string found = verdict(effect, other);
    if (found == "yes") always.push_back(other);
    if (found.rfind("if", 0) == 0) sometimes.push_back(fmt::format("with {} {}", other, found));
  }
  std::string text = fmt::format("{} goes with {}", effect, fmt::join(always, ", "));
  for (const std::string& one : sometimes) text += "; " + one;
  std::erase(text, '`');
  return text;
}

std::string effects_markdown() {
  const std::vector<std::string> names = effect_names();
  std::string text = fmt::format("| goes with | {} |\n| --- |{}\n", fmt::join(names, " | "),
                                 fmt::join(std::vector<std::string>(names.size(), " --- |"), ""));
  for (const std::string& row : names) {
    text += fmt::format("| {} |", row);
    for (const std::string& column : names) text += fmt::format(" {} |", row == column ? "" : verdict(row, column));
    text += "\n";
  }
  text += "\nWhy not:\n\n";
  for (const EffectRule& rule : effect_rules())
    text += fmt::format("* {} with {}{}: {}.\n", rule.effect, rule.other,
                        rule.unless().empty() ? "" : fmt::format(" unless {}", rule.unless()), rule.reason);
  return text;
}

}  // namespace gaussdrift::input
