#include "input/registry.hpp"
#include "base/duration_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "effect/catalogue.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {
namespace {

std::vector<Section> sections() {
  std::vector<Section> all{case_section(),      params_section(),   domain_section(),    velocity_section(),
                           density_section(),   sources_section(),  particles_section(), time_section(),
                           evaluate_section(),  output_section(),   pictures_section(),  tracks_section(),
                           reference_section(), accuracy_section(), checks_section()};
  for (const NamedEffect& effect : effects()) all.push_back(effect_section(effect));
  return all;
}

}  // namespace

const std::vector<Table>& tables() {
  static base::FromCatalogues<std::vector<Table>> list;
  return list.get([] {
    std::vector<Table> all;
    for (Section& section : sections()) all.push_back(std::move(section.table));
    return all;
  });
}

const std::vector<Key>& keys() {
  static base::FromCatalogues<std::vector<Key>> list;
  return list.get([] {
    std::vector<Key> all{version_key()};
    for (const Section& section : sections())
      for (Key key : section.keys) {
        key.table = section.table.name;
        all.push_back(std::move(key));
      }
    return all;
  });
}

const std::vector<Quantity>& quantities() {
  static const std::vector<Quantity> list = {
      {"d", "dimension of the scene, 2 or 3", "", "", "domain.min, domain.max"},
      {"h", "spacing of the lattice on which particles start, the same on all axes",
       "h = L / (n_g - 1), L the longest side of the domain", "length", "particles.per_axis, domain"},
      {"eps", "core radius: the width of a blob", "eps = c h", "length", "particles.overlap, particles.per_axis"},
      {"sigma", "sharpness of the Gaussians that are summed: exp(-sigma r^2)", "sigma = 1 / eps^2", "1 / length^2",
       "particles.overlap, particles.per_axis"},
      {"zeta_eps", "the blob of core radius eps", "zeta_eps(x) = eps^-d zeta(x / eps)", "1 / length^d",
       "particles.cutoff, particles.overlap"},
      {"x_j", "the lattice point where particle j starts", "", "length", "particles.per_axis, domain"},
      {"X_j", "where particle j is at time t", "X_j' = u(X_j, t), X_j(0) = x_j", "length", "velocity"},
      {"alpha_j", "weight of particle j: the mass that it carries", "alpha_j = h^d rho_0(x_j)", "density length^d",
       "density, particles.per_axis"},
      {"rho_eps^h", "sum of all blobs: the density that a run computes",
       "rho_eps^h(x, t) = sum_j alpha_j zeta_eps(x - X_j(t))", "density", ""},
  };
  return list;
}

std::string range_text(const Range& range) {
  const auto& [least, most, least_open, most_open] = range;
  const bool below = std::isfinite(least), above = std::isfinite(most);
  const std::string lower = fmt::format("{} {}", least_open ? "greater than" : "at least", least);
  const std::string upper = fmt::format("{} {}", most_open ? "less than" : "at most", most);
  if (below && above && least == most) return fmt::format("{}", least);
  if (below && above) return lower + " and " + upper;
  return below ? lower : above ? upper : "";
}

const Key& find_key(std::string_view table, std::string_view name, std::string_view value) {
  for (const Key& key : keys())
    if (key.table == table && key.name == name && key.value == value) return key;
  throw std::logic_error(fmt::format("no key {}.{} in the registry", table, name));
}

const Table& find_table(std::string_view name) {
  for (const Table& table : tables())
    if (table.name == name) return table;
  throw std::logic_error(fmt::format("no table {} in the registry", name));
}

std::vector<std::string> key_names(std::string_view table) {
  std::vector<std::string> names;
  for (const Key& key : keys())
    if (key.table == table && std::find(names.begin(), names.end(), key.name) == names.end())
      names.emplace_back(key.name);
  return names;
}

std::vector<std::string> key_names(std::string_view table, std::string_view kind, std::string_view value) {
  std::vector<std::string> names;
  const auto& kinds = find_table(table).kinds;
  const auto excluded = [&](std::string_view name) {
    return name != kind && std::find(kinds.begin(), kinds.end(), name) != kinds.end();
  };
  for (const Key& key : keys())
    if (key.table == table && key.belongs(kind, value) && !excluded(key.name)) names.emplace_back(key.name);
  return names;
}

std::vector<std::string> table_names() {
  std::vector<std::string> names;
  for (const Table& table : tables()) names.emplace_back(table.name);
  return names;
}

std::string type_text(const Key& key) {
  switch (key.type) {
    case Type::text:
      return "a string";
    case Type::texts:
      return "a list of strings";
    case Type::number:
      return "a number or an expression";
    case Type::whole:
      return "a whole number";
    case Type::boolean:
      return "true or false";
    case Type::duration:
      return base::duration_form;
    case Type::numbers:
      return "a list of numbers";
    case Type::point:
      return "a list of numbers, one for each axis";
    case Type::expression:
      return "an expression in a string";
    case Type::expressions:
      return "a list of strings, one expression for each axis";
    case Type::choice:
      return (key.choices.size() == 1 ? "" : "one of ") + quoted_list(key.choices) +
             (key.or_flag ? ", or true or false" : "");
    case Type::choices:
      return "a list of some of " + quoted_list(key.choices);
    case Type::ends:
      return fmt::format("a list with one of {} for each axis, or with a pair of them for its two ends",
                         quoted_list(key.choices));
    case Type::clock:
      return "a table { start = ..., unit = ... }";
  }
  return "";
}

std::string_view first_sentence(std::string_view meaning) { return meaning.substr(0, meaning.find(". ")); }

}  // namespace gaussdrift::input
