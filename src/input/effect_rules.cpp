#include "input/effect_rules.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "input/registry.hpp"

namespace gaussdrift::input {
namespace {

bool exchanges(const EffectsSpec& effects) {
  return effects.diffusion->method == DiffusionSpec::Method::particle_exchange;
}
bool is_weight(const EffectsSpec& effects) { return effects.charge->density.empty(); }

/// The rules about a pair, whichever of the two is named first.
std::vector<const EffectRule*> rules_of(std::string_view one, std::string_view two) {
  std::vector<const EffectRule*> found;
  for (const EffectRule& rule : effect_rules())
    if ((rule.effect == one && rule.other == two) || (rule.effect == two && rule.other == one)) found.push_back(&rule);
  return found;
}

/// "yes", "no", or "if ...".
std::string verdict(std::string_view one, std::string_view two) {
  std::vector<std::string_view> conditions;
  for (const EffectRule* rule : rules_of(one, two)) {
    if (rule->unless.empty()) return "no";
    conditions.push_back(rule->unless);
  }
  return conditions.empty() ? "yes" : fmt::format("if {}", fmt::join(conditions, " and "));
}

}  // namespace

const std::vector<EffectRule>& effect_rules() {
  static const std::vector<EffectRule> rules = {
      {"charge", "reaction", "the charge has a density of its own",
       "the reaction changes the weights, and these are the charges that move the particles",
       "give the charge a density of its own: effects.charge.density",
       [](const EffectsSpec& effects, int) { return is_weight(effects); }},
      {"charge", "diffusion", "`method = \"core-spreading\"`",
       "particle-exchange adds particles during the run, and they cannot be carried from the start",
       "method = \"core-spreading\"", [](const EffectsSpec& effects, int) { return exchanges(effects); }},
      {"charge", "diffusion", "the scene has two dimensions",
       "charges are points in three dimensions, so their field would not spread with the density",
       "leave out one of them", [](const EffectsSpec&, int dimension) { return dimension == 3; }},
      {"charge", "remesh", "the charge is the weight",
       "remeshing makes new particles, which have weights but no charge of their own",
       "leave out one of them, or effects.charge.density",
       [](const EffectsSpec& effects, int) { return !is_weight(effects); }},
      {"vortex", "reaction", "",
       "the reaction changes the weights, and these are the circulations that move the particles",
       "leave out one of them", [](const EffectsSpec&, int) { return true; }},
      {"vortex", "diffusion", "`method = \"core-spreading\"`",
       "particle-exchange adds particles during the run, and they cannot be carried from the start",
       "method = \"core-spreading\"", [](const EffectsSpec& effects, int) { return exchanges(effects); }},
  };
  return rules;
}

std::vector<std::string> effect_names() {
  constexpr std::string_view prefix = "effects.";
  std::vector<std::string> names;
  for (const std::string& name : table_names())
    if (name.rfind(prefix, 0) == 0) names.push_back(name.substr(prefix.size()));
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
                        rule.unless.empty() ? "" : fmt::format(" unless {}", rule.unless), rule.reason);
  return text;
}

}  // namespace gaussdrift::input
