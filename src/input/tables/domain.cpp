// [domain]: the box.
#include <fmt/format.h>

#include <cmath>

#include "input/tables/tables.hpp"

namespace gaussdrift::input {

Section domain_section() {
  return {Table{.name = "domain",
                .required = true,
                .meaning = "the box in which particles start and on which the density is evaluated"},
          {{.name = "min",
            .type = Type::numbers,
            .required = true,
            .unit = "length",
            .meaning = "lower corner: 2 numbers in 2D, 3 numbers in 3D"},
           {.name = "max",
            .type = Type::numbers,
            .required = true,
            .unit = "length",
            .meaning = "upper corner. It lies above `min` on every axis"}}};
}

namespace {

bool is_corner(Reader& in, const Value& value, const Key& key) {
  if (value.items.size() == 2 || value.items.size() == 3) return true;
  in.diagnostics.error(value.place, fmt::format("{} needs 2 numbers (2D) or 3 numbers (3D), found {}", in.label_of(key),
                                                value.items.size()));
  return false;
}

}  // namespace

void read_domain(Reader& in, Domain& domain) {
  const Key &min_key = find_key("domain", "min"), &max_key = find_key("domain", "max");
  const Entry *min_entry = in.require(min_key), *max_entry = in.require(max_key);
  const auto min = min_entry ? in.numbers(*min_entry, min_key) : std::nullopt;
  const auto max = max_entry ? in.numbers(*max_entry, max_key) : std::nullopt;
  const bool min_fits = min && is_corner(in, min_entry->value, min_key),
             max_fits = max && is_corner(in, max_entry->value, max_key);
  if (min_fits && max_fits && min->size() != max->size()) {
    in.diagnostics.error(max_entry->value.place,
                         fmt::format("domain.min has {} numbers, domain.max has {}", min->size(), max->size()),
                         "2 numbers each in 2D, 3 in 3D");
    return;
  }
  if (min_fits || max_fits) in.facts.dimension = static_cast<int>(min_fits ? min->size() : max->size());
  if (!min_fits || !max_fits) return;
  domain.dimension = in.facts.dimension;
  bool valid = true;
  for (std::size_t k = 0; k < min->size(); ++k) {
    const double lower = (*min)[k], upper = (*max)[k];
    domain.min[k] = lower, domain.max[k] = upper;
    if (lower < upper && std::isfinite(upper - lower)) continue;
    valid = false;
    in.diagnostics.error(max_entry->value.items[k].place,
                         lower < upper
                             ? fmt::format("the domain is too wide along {} for double precision", "xyz"[k])
                             : fmt::format("the domain is empty along {}: min = {}, max = {}", "xyz"[k], lower, upper),
                         "min must be less than max on every axis");
  }
  in.facts.domain_valid = valid;
  in.facts.box = {domain.dimension, domain.min, domain.max};
}

void write_domain(Writer& out, const Domain& domain) {
  const auto corner = [&](const std::array<double, 3>& point) {
    return written(std::vector<double>(point.begin(), point.begin() + domain.dimension));
  };
  out.table("domain");
  out.entry("min", corner(domain.min));
  out.entry("max", corner(domain.max));
}

}  // namespace gaussdrift::input
