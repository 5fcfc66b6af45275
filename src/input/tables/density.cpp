// [density]: the density at the start.

#include <fmt/format.h>

#include <algorithm>

#include "effect/catalogue.hpp"
#include "effect/tracer_reactions.hpp"
#include "expression/expression.hpp"
#include "field/density/shapes.hpp"
#include "input/tables/tables.hpp"
#include "sim/grid_fields.hpp"

namespace gaussdrift::input {

Section density_section() {
  std::vector<Key> keys{
      {.name = "expression", .type = Type::expression, .symbol = "rho_0", .meaning = "the density when the run begins"},
      {.name = "shape",
       .type = Type::choice,
       .choices = base::names_of(named_shapes()),
       .meaning = "name of a shape. Its parameters stand beside it"}};
  add_parameters(keys, "shape", named_shapes());
  const std::vector<Key> of_tracer{
      {.name = "name",
       .meaning =
           "name of a tracer. Each name has a density of its own in files, series.csv and pictures; those of one "
           "name add up. `rho` is then the sum of all. Either all `[[density]]` have a name or none has one"},
      {.name = "gain",
       .type = Type::expression,
       .unit = "density / time",
       .meaning = "with `name`: what this density gains in a unit of time along the paths, an expression of all named "
                  "densities, x, y, z, t and params. `\"-0.5*A\"` lets A decay"},
      {.name = "half_life",
       .type = Type::number,
       .range = positive,
       .unit = "time",
       .meaning = "with `name`: the time in which half of it decays, besides its `gain`"},
      {.name = "diffusion",
       .type = Type::number,
       .range = {0, infinity},
       .unit = "length^2 / time",
       .symbol = "D",
       .meaning = "with `name`: its own coefficient of diffusion, at most the `D` of `[effects.diffusion]`, which "
                  "densities without it have. With `core-spreading` reactions are refused, and `random-walk` spreads "
                  "all alike"},
      {.name = "exact",
       .type = Type::expression,
       .meaning = "with `name`: its exact density, an expression in x, y, z, t and params, that outputs are compared "
                  "with"}};
  keys.insert(keys.end(), of_tracer.begin(), of_tracer.end());
  keys.push_back(
      {.name = "file",
       .meaning =
           "a file of ParaView with the density on a grid (.vti, .pvti, .vtr, .vts, legacy .vtk), or of NetCDF (.nc). "
           "Or a "
           "picture (.png), from 0 for black to 1 for white, or rows of numbers (.csv), the uppermost first: they fill "
           "the domain. The path is relative to the case file"});
  const std::vector<Key> of_file =
      grid_file_keys("zero", "what to do where the file has no value. The choices are those of `velocity.missing`");
  keys.insert(keys.end(), of_file.begin(), of_file.end());
  for (Key key : {samples_key("`x,y[,z],rho`"), kernel_key(), width_key(), width_by_key(), regularisation_key()})
    keys.push_back(std::move(key));
  return {
      Table{.name = "density",
            .required = true,
            .meaning = "the density rho_0 when the run begins. Several `[[density]]` add up. With `[[source]]` it may "
                       "be left out: then the run starts empty",
            .unless = "source",
            .kinds = {"expression", "shape", "file", "samples"}},
      keys};
}

namespace {

using Kind = Value::Kind;

/// The names of all parts, one each; empty where a part has none.
std::vector<std::string> names_of_parts(const Reader& in) {
  const Entry* density = in.top("density");
  std::vector<std::string> names;
  if (!density) return names;
  const std::vector<Value> one{density->value};
  for (const Value& part : density->value.kind == Kind::list ? density->value.items : one) {
    const Entry* name = part.find("name");
    names.push_back(name && name->value.kind == Kind::text ? name->value.text : "");
  }
  return names;
}

/// Arrays of files and variables of expressions have names that a tracer cannot have.
bool is_taken(const Reader& in, const std::string& name) {
  for (const std::string_view other : {"x", "y", "z", "t", "u", "id", "alpha", "rho", "rho_exact", "error", "pi", "e"})
    if (name == other) return true;
  for (const GridFieldKind& field : grid_fields())
    if (field.about.name == name) return true;
  return std::any_of(in.params.begin(), in.params.end(), [&](const Parameter& one) { return one.name == name; });
}

void check_name(Reader& in, const Value& name) {
  if (!is_name(name.text) || is_reserved_name(name.text))
    in.diagnostics.error(name.place, fmt::format("\"{}\" cannot be the name of a density", name.text),
                         "a letter, then letters, digits and underscores, and no name of a function");
  else if (is_taken(in, name.text))
    in.diagnostics.error(name.place, fmt::format("the name \"{}\" is taken", name.text),
                         "expressions or files have another quantity of this name; choose a longer one");
}

/// What a part says of its tracer, beside its density at the start.
void read_tracer(Reader& in, Case& spec, const std::vector<std::string>& names) {
  const Entry* name = in.find("density", "name");
  if (!name) {
    for (const char* key : {"gain", "half_life", "diffusion", "exact"})
      if (const Entry* entry = in.find("density", key))
        in.diagnostics.error(entry->place, fmt::format("\"{}\" goes with \"name\"", key),
                             "without names the densities are one, which effects and [reference] are for");
    return;
  }
  const std::string text = in.text("density", "name");
  check_name(in, name->value);
  auto tracer =
      std::find_if(spec.tracers.begin(), spec.tracers.end(), [&](const auto& one) { return one.name == text; });
  if (tracer == spec.tracers.end()) tracer = spec.tracers.insert(tracer, TracerSpec{.name = text});
  tracer->parts.push_back(spec.density.size() - 1);
  const auto once = [&](const Entry* entry, bool said) {
    if (entry && said)
      in.diagnostics.error(entry->place, fmt::format("\"{}\" of {} is said twice", entry->name, text),
                           "several densities of one name add up; one of them says what happens to it");
    return entry && !said;
  };
  std::vector<std::string> tracers;
  for (const std::string& one : names)
    if (std::find(tracers.begin(), tracers.end(), one) == tracers.end()) tracers.push_back(one);
  if (const Entry* gain = in.find("density", "gain"); once(gain, !tracer->gain.empty()))
    tracer->gain = in.tracer_expression(gain->value, in.label_of(find_key("density", "gain")), tracers);
  if (const Entry* life = in.find("density", "half_life"); once(life, tracer->half_life.has_value()))
    if (const auto number = in.number("density", "half_life")) tracer->half_life = number->number;
  if (const Entry* diffusion = in.find("density", "diffusion"); once(diffusion, tracer->diffusion.has_value()))
    if (const auto number = in.number("density", "diffusion")) tracer->diffusion = number->number;
  if (const Entry* exact = in.find("density", "exact"); once(exact, !tracer->exact.empty()))
    tracer->exact = in.field_expression(exact->value, in.label_of(find_key("density", "exact")), true);
}

}  // namespace

void read_density(Reader& in, Case& spec) {
  const std::vector<std::string> names = names_of_parts(in);
  in.each_part("density", [&](std::string_view kind, const Value& value) {
    const Key& key = find_key("density", kind);
    if (kind == "expression")
      spec.density.emplace_back(ExpressionDensitySpec{in.field_expression(value, in.label_of(key), false)});
    if (kind == "file") spec.density.emplace_back(grid_file<FileDensitySpec>(in, "density", value, 1, 1));
    if (kind == "samples") spec.density.emplace_back(sampled_density(in, value));
    if (kind == "shape")
      spec.density.emplace_back(
          ShapeDensitySpec{value.text, in.arguments(key, find_named_shape(value.text).about, value)});
    read_tracer(in, spec, names);
  });
  const auto nameless = std::count(names.begin(), names.end(), "");
  if (nameless > 0 && static_cast<std::size_t>(nameless) < names.size())
    in.diagnostics.error(in.top("density")->place, "some densities have a name and some have none",
                         "give each a name, or none; several of one name add up");
  if (spec.tracers.size() > most_tracers)
    in.diagnostics.error(
        in.top("density")->place,
        fmt::format("{} named densities are too many; at most {} are possible", spec.tracers.size(), most_tracers));
}

namespace {

/// What a coefficient of diffusion of a density asks for, beside what the effect itself says.
void check_own_diffusion(Reader& in, const Case& spec, const Place& place) {
  const auto own = std::find_if(spec.tracers.begin(), spec.tracers.end(),
                                [](const TracerSpec& tracer) { return tracer.diffusion.has_value(); });
  if (own == spec.tracers.end()) return;
  const auto all = effects_of(spec.effects);
  const auto diffuses =
      std::find_if(all.begin(), all.end(), [](const auto& one) { return one.first->traits.diffuses; });
  if (diffuses == all.end())
    return in.diagnostics.error(place,
                                fmt::format("{} has a diffusion, and the case has no effect that diffuses", own->name),
                                "[effects.diffusion] with D, the largest coefficient, and a method");
  if (in.diagnostics.errors() > 0 || spreading_of_tracers(spec).empty()) return;
  const auto of_density = [](const GridField& field) { return !field.is_of_flow && !field.is_of_particles; };
  std::string name;
  for (const GridField& field : spec.output.fields)
    if (of_density(field) && field.name != "rho") name = field.name;
  if (spec.output.tracks)
    for (const GridField& field : spec.output.tracks->fields)
      if (of_density(field)) name = field.name;
  if (!name.empty())
    in.diagnostics.error(
        place,
        fmt::format("\"{}\" is one of all densities, whose blobs have different widths by the "
                    "diffusion of {}",
                    name, own->name),
        fmt::format("leave {} out, or choose method = \"particle-exchange\" in [effects.diffusion]", name));
}

}  // namespace

void check_tracers(Reader& in, const Case& spec) {
  const Entry* density = in.top("density");
  if (!density || spec.tracers.empty()) return;
  for (const auto& [effect, values] : effects_of(spec.effects)) {
    const EffectTraits& traits = effect->traits;
    const int dimension = spec.domain.dimension;
    std::string reason;
    if (traits.replaces_particles.of(values, dimension)) reason = traits.replaces_particles.words;
    if (!reason.empty()) reason += ", which have one weight each";
    if (reason.empty() && traits.particles_interact) reason = "which of the densities moves the particles is not said";
    if (!reason.empty())
      in.diagnostics.error(density->place,
                           fmt::format("named densities do not go with [{}]: {}", table_of(*effect), reason),
                           "leave out the effect, or the names");
  }
  check_own_diffusion(in, spec, density->place);
  if (in.diagnostics.errors() == 0 && !spec.sources.empty() && !tracers_react_linearly(spec))
    in.diagnostics.error(in.top("source")->place,
                         "[[source]] does not go with reactions that are not sums of multiples of named densities: "
                         "what is released lies upon other particles, and they would not see each other",
                         "reactions such as \"-0.5*A + 0.1*B\" go with it");
}

namespace {

void write_part(Writer& out, const ExpressionDensitySpec& spec) { out.entry("expression", written(spec.text)); }

void write_part(Writer& out, const FileDensitySpec& spec) { write_grid_file(out, spec); }

void write_part(Writer& out, const ShapeDensitySpec& spec) {
  out.entry("shape", written(spec.shape));
  out.arguments("density", spec.shape, spec.arguments);
}

}  // namespace

void write_density(Writer& out, const Case& spec) {
  for (std::size_t part = 0; part < spec.density.size(); ++part) {
    out.part("density", spec.density.size());
    for (const TracerSpec& tracer : spec.tracers) {
      if (std::find(tracer.parts.begin(), tracer.parts.end(), part) == tracer.parts.end()) continue;
      out.entry("name", written(tracer.name));
      if (part != tracer.parts.front()) continue;
      if (!tracer.gain.empty()) out.entry("gain", written(tracer.gain));
      if (tracer.half_life) out.entry("half_life", written(*tracer.half_life));
      if (tracer.diffusion) out.entry("diffusion", written(*tracer.diffusion));
      if (!tracer.exact.empty()) out.entry("exact", written(tracer.exact));
    }
    std::visit([&](const auto& one) { write_part(out, one); }, spec.density[part]);
  }
}

}  // namespace gaussdrift::input
