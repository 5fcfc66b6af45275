// [effects.*]: what a case names beside transport.
#include <fmt/format.h>

#include <algorithm>

#include "effect/catalogue.hpp"
#include "effect/pair_images.hpp"
#include "input/effect_rules.hpp"
#include "input/tables/tables.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::input {

Section effect_section(const NamedEffect& effect) {
  Section section{Table{.name = table_of(effect), .required = false, .meaning = std::string(effect.about.meaning)}, {}};
  for (const NamedParameter& parameter : effect.about.parameters) section.keys.push_back(key_of(parameter));
  if (effect.field.empty()) return section;
  section.keys.push_back(
      {.name = "file",
       .meaning = fmt::format("in place of `{}`, a file with {} on a grid. It may be any that `density.file` may be. "
                              "The path is relative to the case file",
                              effect.field, effect.field_name)});
  for (Key& key : grid_file_keys("clamp",
                                 "what to do where the file has no value. The choices are those of "
                                 "`velocity.missing`"))
    section.keys.push_back(std::move(key));
  return section;
}

using Kind = Value::Kind;

namespace {

bool is_complete(const NamedEffect& effect, const EffectSpec& values) {
  return std::all_of(effect.about.parameters.begin(), effect.about.parameters.end(),
                     [&](const NamedParameter& parameter) {
                       return parameter.optional || values.has(parameter.name) || !applies(parameter, values);
                     });
}

/// Some key has been complained about, so that it has no value.
bool has_unread_keys(Reader& in, const NamedEffect& effect, const EffectSpec& values) {
  return std::any_of(effect.about.parameters.begin(), effect.about.parameters.end(),
                     [&](const NamedParameter& parameter) {
                       return in.find(table_of(effect), parameter.name) && !values.has(parameter.name);
                     });
}

/// A parameter that another one replaces.
void refuse_both(Reader& in, const std::string& home, const NamedParameter& parameter) {
  const Entry *one = in.find(home, parameter.replaced_by), *two = in.find(home, parameter.name);
  if (!one || !two) return;
  in.diagnostics.error(
      comes_before(one->place, two->place) ? two->place : one->place,
      fmt::format("[{}] has both \"{}\" and \"{}\"", home, one->name, two->name),
      fmt::format("{}; {}", meaning_note(find_key(home, one->name)), meaning_note(find_key(home, two->name))));
}

void read_value(Reader& in, const NamedParameter& parameter, const Key& key, const Entry& entry, EffectSpec& given) {
  const auto take_number = [&] {
    if (const auto value = in.number_of(key, entry)) given.numbers.emplace_back(key.name, std::vector{*value});
  };
  switch (parameter.kind) {
    case NamedParameter::Kind::number:
    case NamedParameter::Kind::whole:
      return take_number();
    case NamedParameter::Kind::point:
      if (const auto values = in.point_of(key, entry)) given.numbers.emplace_back(key.name, *values);
      return;
    case NamedParameter::Kind::choice:
      given.texts.emplace_back(key.name, in.choice(key.table, key.name));
      return;
    case NamedParameter::Kind::expression:
    case NamedParameter::Kind::expression_in_time:
      given.texts.emplace_back(key.name,
                               in.field_expression(entry.value, in.label_of(key),
                                                   parameter.kind == NamedParameter::Kind::expression_in_time));
      return;
  }
}

/// Data in place of the field of the effect, and keys that go with data alone.
void read_file(Reader& in, const NamedEffect& effect, EffectSpec& given) {
  const std::string home = table_of(effect);
  if (const Entry* entry = in.find(home, "file")) {
    given.file = grid_file<GridFileSpec>(in, home, entry->value, 1, 1);
    return;
  }
  for (const Key& key : effect_section(effect).keys)
    if (const Entry* entry = key.with == "file" ? in.find(home, key.name) : nullptr)
      in.diagnostics.error(entry->place, fmt::format("\"{}\" goes with file", key.name));
}

/// What its keys say, with defaults.
EffectSpec effect_values(Reader& in, const NamedEffect& effect) {
  const std::string home = table_of(effect);
  EffectSpec given{.name = std::string(effect.about.name)};
  for (const NamedParameter& parameter : effect.about.parameters) {
    const Key& key = find_key(home, parameter.name);
    const Entry* entry = key.required ? in.require(key) : in.find(home, key.name);
    if (!entry) continue;
    read_value(in, parameter, key, *entry, given);
    if (!parameter.replaced_by.empty())
      refuse_both(in, home, parameter);
    else if (!applies(parameter, complete_effect(effect, given)))
      in.diagnostics.error(entry->value.place, fmt::format("\"{}\" goes with {} = \"{}\"", parameter.name,
                                                           parameter.with, parameter.value));
  }
  if (!effect.field.empty()) read_file(in, effect, given);
  return complete_effect(effect, given);
}

/// Effects that need to know their steps do not go with a method that chooses them.
void check_steps(Reader& in, const NamedEffect& effect, const EffectSpec& values, const Case& spec) {
  const Trait& fixed = effect.traits.needs_fixed_steps;
  const Entry* method = in.find("time", "method");
  if (!method || !fixed.of(values, in.facts.dimension) || !time::is_adaptive(time::find_tableau(spec.time.method)))
    return;
  in.diagnostics.error(
      method->value.place,
      fmt::format("steps that are chosen by their error do not go with [{}] {}", table_of(effect), fixed.words),
      fmt::format("method = \"{}\"{}{}", time::tableaux().front().name, fixed.remedy.empty() ? "" : " with ",
                  fixed.remedy));
}

/// Fields of the flow are those of the prescribed one, which is not the velocity where particles move each other.
void refuse_fields(Reader& in, const NamedEffect& effect, const OutputSpec& output) {
  const Entry* fields = in.find("output", "fields");
  if (!fields || !effect.traits.particles_interact) return;
  for (const GridField& field : output.fields)
    if (field.is_of_flow)
      in.diagnostics.error(
          fields->value.place,
          fmt::format("\"{}\" is known of the prescribed flow alone, and with [{}] particles move each "
                      "other",
                      field.name, table_of(effect)),
          "leave it out; the particle files have the whole velocity at the particles");
}

/// Fields of particles are of those that stay who they are.
void refuse_particle_fields(Reader& in, const NamedEffect& effect, const EffectSpec& values, const Case& spec) {
  const Entry* fields = in.find("output", "fields");
  if (!fields) return;
  const EffectTraits& traits = effect.traits;
  for (const auto* trait : {&traits.adds_particles, &traits.replaces_particles})
    if (trait->of(values, spec.domain.dimension))
      for (const GridField& field : spec.output.fields)
        if (field.is_of_particles)
          in.diagnostics.error(
              fields->value.place,
              fmt::format("\"{}\" belongs to particles of the start, and with [{}] {}", field.name, table_of(effect),
                          trait->words),
              traits.diffuses ? "leave it out; method = \"core-spreading\" goes with it" : "leave it out");
}

/// Effects that know nothing of the edges of the domain.
void refuse_edges(Reader& in, const NamedEffect& effect, const EffectSpec& values, const Case& spec) {
  const Entry* edges = in.find("domain", "edges");
  if (!edges || !spec.domain.has_edges()) return;
  const EffectTraits& traits = effect.traits;
  for (const Trait* trait : {&traits.adds_particles, &traits.replaces_particles}) {
    if (traits.knows_edges || !trait->of(values, spec.domain.dimension)) continue;
    in.diagnostics.error(edges->value.place,
                         fmt::format("domain.edges does not go with [{}]: {}, on a lattice that has no edges",
                                     table_of(effect), trait->words),
                         "leave out one of them");
    return;
  }
  if (!traits.particles_interact) return;
  if (const Unsummable images = unsummable_images(spec.domain); !images.reason.empty())
    in.diagnostics.error(edges->value.place,
                         fmt::format("domain.edges does not go with [{}]: {}", table_of(effect), images.reason),
                         images.remedy);
}

/// Effects that know particles of the lattice alone.
void refuse_sources(Reader& in, const NamedEffect& effect, const EffectSpec& values, const Case& spec) {
  const Entry* source = in.top("source");
  if (!source || spec.sources.empty()) return;
  const EffectTraits& traits = effect.traits;
  const int dimension = spec.domain.dimension;
  std::string reason;
  if (traits.adds_particles.of(values, dimension)) reason = traits.adds_particles.words;
  if (traits.replaces_particles.of(values, dimension)) reason = traits.replaces_particles.words;
  if (!reason.empty()) reason += ", on the lattice on which released particles do not stand";
  if (reason.empty() && traits.widens_blobs.of(values, dimension))
    reason = fmt::format("{}, all blobs have the same width, and what is released later has to be narrower",
                         traits.widens_blobs.words);
  if (reason.empty() && traits.particles_interact)
    reason = "how far apart particles must be to move each other is chosen for those of the start";
  if (!reason.empty())
    in.diagnostics.error(source->place, fmt::format("[[source]] does not go with [{}]: {}", table_of(effect), reason),
                         traits.diffuses ? "method = \"random-walk\" goes with sources" : "leave out one of them");
}

/// Effects that a run backwards in time cannot undo.
void refuse_backwards(Reader& in, const NamedEffect& effect, const EffectSpec& values, const Case& spec) {
  const Trait& irreversible = effect.traits.irreversible;
  if (!spec.time.backwards || !irreversible.of(values, spec.domain.dimension)) return;
  in.diagnostics.error(in.find("time", "end")->value.place,
                       fmt::format("time.end lies before time.start, so that the run goes backwards in time, and that "
                                   "does not go with [{}]: {}",
                                   table_of(effect), irreversible.words),
                       "leave out the effect, or let the run go forwards");
}

/// Effects that put particles on a lattice, which knows no land.
void refuse_coast(Reader& in, const NamedEffect& effect, const EffectSpec& values, const Case& spec) {
  const Entry* coast = in.find("domain", "coast");
  if (!coast) return;
  const EffectTraits& traits = effect.traits;
  for (const auto* trait : {&traits.adds_particles, &traits.replaces_particles})
    if (trait->of(values, spec.domain.dimension)) {
      in.diagnostics.error(coast->value.place,
                           fmt::format("domain.coast does not go with [{}]: {}, on a lattice that knows no land",
                                       table_of(effect), trait->words),
                           traits.diffuses
                               ? "method = \"core-spreading\" goes with a coast, and so does \"random-walk\""
                               : "leave out one of them");
      return;
    }
}

/// What does not go with the case, or with another effect.
void refuse_effects(Reader& in, const std::vector<std::pair<const NamedEffect*, EffectSpec>>& read, const Case& spec) {
  const auto refuse = [&](const std::string& name, const std::string& what, const std::string& remedy) {
    in.diagnostics.error(in.table("effects." + name)->place, fmt::format("[effects.{}] {}", name, what), remedy);
  };
  for (const auto& [effect, values] : read) {
    const NamedFormula& about = effect->about;
    if (in.facts.dimension && (in.facts.dimension < about.least_dimension || in.facts.dimension > about.most_dimension))
      refuse(values.name,
             in.facts.dimension == 3 ? "is for two dimensions, the domain has three"
                                     : "is for three dimensions, the domain has two",
             "");
    check_steps(in, *effect, values, spec);
    if (is_complete(*effect, values)) {
      refuse_edges(in, *effect, values, spec);
      refuse_sources(in, *effect, values, spec);
      refuse_coast(in, *effect, values, spec);
      refuse_backwards(in, *effect, values, spec);
      refuse_particle_fields(in, *effect, values, spec);
    }
    if (!effect->problems || !is_complete(*effect, values) || has_unread_keys(in, *effect, values)) continue;
    for (const Complaint& problem : effect->problems(values, spec)) {
      const Entry* entry = in.find(table_of(*effect), problem.key);
      if (entry)
        in.diagnostics.error(entry->value.place, problem.message, problem.remedy);
      else if (!in.is_meant(fmt::format("{}.{}", table_of(*effect), problem.key)))
        refuse(values.name, problem.message, problem.remedy);
    }
  }
  for (const auto& [effect, values] : read) refuse_fields(in, *effect, spec.output);
  for (const EffectRule& rule : effect_rules()) {
    const EffectSpec *one = spec.effects.find(rule.effect), *two = spec.effects.find(rule.other);
    if (!one || !two || !rule.apart(*one, *two, in.facts.dimension)) continue;
    const std::string unless = rule.unless().empty() ? "" : fmt::format(" unless {}", without_backticks(rule.unless()));
    refuse(rule.effect, fmt::format("does not go with [effects.{}]{}: {}", rule.other, unless, rule.reason),
           fmt::format("{}; {}", rule.remedy, goes_with(rule.effect)));
  }
}

}  // namespace

void read_effects(Reader& in, Case& spec) {
  std::vector<std::pair<const NamedEffect*, EffectSpec>> read;
  for (const NamedEffect& effect : effects())
    if (in.table(table_of(effect))) read.emplace_back(&effect, effect_values(in, effect));
  for (const auto& [effect, values] : read) spec.effects.list.push_back(values);
  refuse_effects(in, read, spec);
}

namespace {

std::string written_value(const NamedParameter& parameter, const EffectSpec& effect) {
  switch (parameter.kind) {
    case NamedParameter::Kind::number:
      return written(effect.number(parameter.name));
    case NamedParameter::Kind::whole:
      return fmt::format("{:.0f}", effect.number(parameter.name));
    case NamedParameter::Kind::point:
      return written(effect.point(parameter.name));
    case NamedParameter::Kind::choice:
    case NamedParameter::Kind::expression:
    case NamedParameter::Kind::expression_in_time:
      return written(effect.text(parameter.name));
  }
  return "";
}

}  // namespace

void write_effects(Writer& out, const EffectsSpec& list) {
  for (const auto& [effect, values] : effects_of(list)) {
    out.table(table_of(*effect));
    for (const NamedParameter& parameter : effect->about.parameters)
      if (values.has(parameter.name)) out.entry(parameter.name, written_value(parameter, values));
    if (values.file) write_grid_file(out, *values.file);
  }
}

}  // namespace gaussdrift::input
