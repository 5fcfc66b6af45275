#include "input/sphere_rules.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <variant>

#include "effect/catalogue.hpp"
#include "effect/tracer_reactions.hpp"
#include "field/density/shapes.hpp"
#include "field/named/named_fields.hpp"
#include "sim/grid_fields.hpp"

namespace gaussdrift::input {

namespace {

constexpr std::string_view no_lengths = "places are longitudes and latitudes (domain.coordinates)";

/// Where a part of a table that may be repeated stands.
Place place_of_part(const Reader& in, std::string_view table, std::size_t number) {
  const Value& value = in.top(table)->value;
  return value.kind == Value::Kind::list && number < value.items.size() ? value.items[number].place : value.place;
}

void check_velocity(Reader& in, const Case& spec) {
  const bool sphere = spec.domain.on_sphere();
  for (std::size_t i = 0; i < spec.velocity.size(); ++i) {
    const Place place = place_of_part(in, "velocity", i);
    if (const auto* named = std::get_if<NamedVelocitySpec>(&spec.velocity[i])) {
      if (find_named_field(named->field).on_sphere == sphere) continue;
      in.diagnostics.error(place,
                           sphere ? fmt::format("the field \"{}\" is one of lengths, and {}", named->field, no_lengths)
                                  : fmt::format("the field \"{}\" is one of longitudes and latitudes", named->field),
                           sphere ? "write u = [...] or streamfunction = \"...\", or name a field of the sphere"
                                  : "coordinates = \"longitude latitude\" in [domain]");
    } else if (sphere && (std::holds_alternative<GaussianVelocitySpec>(spec.velocity[i]) ||
                          std::holds_alternative<SamplesVelocitySpec>(spec.velocity[i]))) {
      in.diagnostics.error(
          place, fmt::format("a velocity fitted to points measures distances in the plane, and {}", no_lengths),
          "bring the velocity to a grid: file = \"...\"");
    }
  }
}

void check_densities(Reader& in, const Case& spec) {
  for (std::size_t i = 0; i < spec.density.size(); ++i)
    if (std::holds_alternative<SamplesDensitySpec>(spec.density[i]))
      in.diagnostics.error(
          place_of_part(in, "density", i),
          fmt::format("a density fitted to points measures distances in the plane, and {}", no_lengths),
          "bring the density to a grid: file = \"...\"");
  for (std::size_t i = 0; i < spec.sources.size(); ++i)
    if (std::holds_alternative<FaceSourceSpec>(spec.sources[i].what))
      in.diagnostics.error(
          place_of_part(in, "source", i),
          fmt::format("what comes in through a face is known in the plane and in space, and {}", no_lengths),
          "release it from points or from a shape beside the face");
  if (!spec.tracers.empty() && !tracers_react_linearly(spec))
    in.diagnostics.error(place_of_part(in, "density", 0),
                         "on a sphere named densities react as sums of multiples of tracers alone: particles at "
                         "different latitudes stand for different areas",
                         "gains like \"-2*A + B\"");
}

void check_outputs(Reader& in, const Case& spec) {
  const auto refuse = [&](const Entry* entry, const GridField& field) {
    const GridFieldKind& kind = find_grid_field(field.name);
    const bool compares = kind.of_particles.compares_neighbours;
    if (!entry || !(kind.of_density || compares)) return;
    in.diagnostics.error(entry->value.place,
                         fmt::format("\"{}\" is a derivative by lengths, and {}", field.name, no_lengths),
                         compares ? "leave it out, or take a domain in lengths" : "leave it out");
  };
  for (const GridField& field : spec.output.fields) refuse(in.find("output", "fields"), field);
  if (spec.output.tracks)
    for (const GridField& field : spec.output.tracks->fields) refuse(in.find("output.tracks", "fields"), field);
}

}  // namespace

void check_sphere(Reader& in, const Case& spec) {
  if (in.diagnostics.errors() > 0) return;
  check_velocity(in, spec);
  if (!spec.domain.on_sphere()) return;
  check_densities(in, spec);
  check_outputs(in, spec);
  for (const auto& [effect, values] : effects_of(spec.effects)) {
    const Trait& trait = effect->traits.needs_lengths;
    if (trait.of(values, spec.domain.dimension))
      in.diagnostics.error(
          in.table(table_of(*effect))->place,
          fmt::format("[{}] does not go with longitudes and latitudes: {}", table_of(*effect), trait.words),
          std::string(trait.remedy.empty() ? "leave it out" : trait.remedy));
  }
  if (spec.domain.coast == AtCoast::slide)
    in.diagnostics.error(in.find("domain", "coast")->value.place,
                         fmt::format("sliding along a coast measures directions in the plane, and {}", no_lengths),
                         "coast = \"stop\" or \"remove\"");
}

}  // namespace gaussdrift::input
