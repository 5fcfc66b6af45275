#include "effect/catalogue.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace gaussdrift {

namespace named {
NamedEffect reaction();
NamedEffect diffusion();
NamedEffect charge();
NamedEffect vortex();
NamedEffect remesh();
}  // namespace named

namespace {

bool is_text(const NamedParameter& parameter) {
  using Kind = NamedParameter::Kind;
  return parameter.kind == Kind::choice || parameter.kind == Kind::expression ||
         parameter.kind == Kind::expression_in_time;
}

bool any_has(const EffectsSpec& named, bool EffectTraits::*trait) {
  const auto present = effects_of(named);
  return std::any_of(present.begin(), present.end(), [trait](const auto& one) { return one.first->traits.*trait; });
}

}  // namespace

const std::vector<NamedEffect>& effects() { return base::catalogue<NamedEffect>(); }

std::string table_of(const NamedEffect& effect) { return fmt::format("effects.{}", effect.about.name); }

double EffectScene::cell() const { return seeding.largest_cell(); }

std::vector<std::pair<const NamedEffect*, EffectSpec>> effects_of(const EffectsSpec& named) {
  for (const EffectSpec& spec : named.list)
    if (!base::find_or_null(effects(), spec.name)) throw std::invalid_argument("no effect is called " + spec.name);
  std::vector<std::pair<const NamedEffect*, EffectSpec>> found;
  for (const NamedEffect& effect : effects())
    if (const EffectSpec* spec = named.find(effect.about.name))
      found.emplace_back(&effect, complete_effect(effect, *spec));
  return found;
}

bool applies(const NamedParameter& parameter, const EffectSpec& effect) {
  if (!parameter.replaced_by.empty() && effect.has(parameter.replaced_by)) return false;
  return parameter.with.empty() || (effect.has(parameter.with) && effect.text(parameter.with) == parameter.value);
}

EffectSpec complete_effect(const NamedEffect& effect, const EffectSpec& given) {
  EffectSpec result{.name = std::string(effect.about.name), .file = given.file};
  for (const NamedParameter& parameter : effect.about.parameters) {
    const std::string_view key = parameter.name;
    if (given.has(key)) {
      if (is_text(parameter))
        result.texts.emplace_back(key, given.text(key));
      else
        result.numbers.emplace_back(key, given.point(key));
    } else if (!parameter.fallback.empty() && applies(parameter, result)) {
      if (is_text(parameter))
        result.texts.emplace_back(key, parameter.fallback);
      else
        result.numbers.emplace_back(key, default_value(parameter, {}));
    }
  }
  return result;
}

bool particles_interact(const EffectsSpec& named) { return any_has(named, &EffectTraits::particles_interact); }

bool flat_patches_ripple(const EffectsSpec& named) { return any_has(named, &EffectTraits::flat_patches_ripple); }

double spreading(const EffectsSpec& named) {
  double rate = 0;
  for (const auto& [effect, spec] : effects_of(named))
    if (effect->spreading) rate += effect->spreading(spec);
  return rate;
}

std::vector<double> spreading_of_tracers(const Case& spec) {
  for (const auto& [effect, values] : effects_of(spec.effects))
    if (effect->spreading_of_tracers)
      if (std::vector<double> parts = effect->spreading_of_tracers(values, spec); !parts.empty()) return parts;
  return {};
}

std::optional<Tensor> spreading_shape(const EffectsSpec& named, int dimension) {
  for (const auto& [effect, spec] : effects_of(named))
    if (effect->spreading_shape)
      if (auto shape = effect->spreading_shape(spec, dimension)) return shape;
  return std::nullopt;
}

std::string beyond_budgets(const EffectsSpec& named, int dimension) {
  const auto present = effects_of(named);
  std::string reason;
  for (const auto& [effect, spec] : present)
    if (effect->traits.moves_weight.of(spec, dimension)) {
      reason = effect->traits.moves_weight.words;
      break;
    }
  if (reason.empty() && particles_interact(named)) reason = "the paths of particles that move each other are not known";
  for (const auto& [effect, spec] : present)
    if (reason.empty() && effect->decay_rate.empty())
      reason = "what [effects." + spec.name + "] does is not known to it";
  return reason.empty() ? "" : reason + "; a budget knows about " + known_to_budgets();
}

std::string known_to_budgets() {
  std::string words = "transport";
  for (const NamedEffect& effect : effects())
    if (!effect.decay_rate.empty()) words += fmt::format(" and {}", effect.about.name);
  return words;
}

std::string_view carried_besides(const EffectsSpec& named) {
  for (const auto& [effect, spec] : effects_of(named))
    if (!effect->carried.empty() && spec.has(effect->carried)) return effect->carried_name;
  return {};
}

std::string largest_of_carried() {
  std::string words;
  for (const NamedEffect& effect : effects())
    if (!effect.carried.empty()) words += fmt::format(", and of the largest {}", effect.carried_name);
  return words;
}

const NamedEffect* overlap_restorer() {
  for (const NamedEffect& effect : effects())
    if (effect.traits.restores_overlap) return &effect;
  return nullptr;
}

std::string restorers_table() {
  const NamedEffect* effect = overlap_restorer();
  return effect ? fmt::format("[{}]", table_of(*effect)) : "more overlap";
}

}  // namespace gaussdrift

namespace gaussdrift::base {

template <>
std::vector<NamedEffect>& catalogue() {
  static std::vector<NamedEffect> all{
      named::reaction(), named::diffusion(), named::charge(), named::vortex(), named::remesh(),
  };
  return all;
}

}  // namespace gaussdrift::base
