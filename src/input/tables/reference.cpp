// [reference]: what every output is compared with.
#include <fmt/format.h>

#include <algorithm>

#include "effect/catalogue.hpp"
#include "effect/tracer_reactions.hpp"
#include "field/gridded/grid_data.hpp"
#include "input/tables/tables.hpp"
#include "render/styles.hpp"

namespace gaussdrift::input {

Section reference_section() {
  return {
      Table{.name = "reference",
            .required = false,
            .meaning =
                "the exact density with which every output is compared. It gives the norms of the error, and the "
                "arrays `rho_exact` and `error` in the files"},
      {{.name = "kind",
        .type = Type::choice,
        .fallback = "characteristics",
        .choices = {"characteristics", "exact", "none"},
        .meaning = "where the exact density comes from. `characteristics` traces every grid point back to the start. "
                   "`exact` takes a formula. `none` compares with nothing and costs nothing"},
       {.name = "rho",
        .type = Type::expression,
        .symbol = "rho",
        .meaning = "for `kind = \"exact\"`: the exact density, an expression in x, y, z, t and params"},
       {.name = "points",
        .type = Type::whole,
        .range = {16, 1e9},
        .meaning =
            "largest number of grid points that are compared. If the grid has more points, a sample is compared: "
            "half of it lies where there is density, and the largest values belong to it. The files then have no "
            "`rho_exact` and `error`. Without this key the whole grid is compared if a picture shows the error, "
            "or if there are density files and the comparison takes at most 15 % of the work of the run. "
            "Otherwise a sample is compared that takes that much, 16 to 4096 points. It has at most 256 points "
            "where the velocity or a rate of decay is not smooth (data on a grid, `abs`, ...). If 16 points are too "
            "many, "
            "the error is not measured, unless a check or a target needs it"}}};
}

namespace {

bool shows_error(std::string_view style) {
  const auto& all = render::styles();
  return std::any_of(all.begin(), all.end(),
                     [&](const render::Style& one) { return one.about.name == style && one.about.shows_error; });
}

}  // namespace

using Kind = Value::Kind;

namespace {

/// A velocity whose data are read on the way, each time once for all particles; empty: there is none.
std::string read_on_the_way(const Case& spec) {
  for (const VelocitySpec& part : spec.velocity)
    if (const auto* file = std::get_if<FileVelocitySpec>(&part); file && file->data && file->data->levels)
      return file->data->name;
  return "";
}

}  // namespace

void read_reference(Reader& in, Case& spec) {
  if (const Entry* coast = in.find("domain", "coast"); coast && !read_on_the_way(spec).empty())
    in.diagnostics.error(
        coast->value.place,
        fmt::format("domain.coast needs to know where land is, and {} is too long to be held", read_on_the_way(spec)),
        "leave it out: a run then ends where a particle reaches land; or take fewer times or points");
  ReferenceSpec& reference = spec.reference;
  const Key& key = find_key("reference", "kind");
  const Entry *kind = in.find("reference", "kind"), *rho = in.find("reference", "rho");
  std::string chosen = in.choice("reference", "kind");
  // With these no path knows the density.
  std::string without;
  for (const auto& [effect, values] : effects_of(spec.effects))
    if (without.empty() && !effect->keeps_paths()) without = values.name;
  if (!without.empty() && kind && chosen == "characteristics")
    in.diagnostics.error(kind->value.place,
                         fmt::format("with [effects.{}] the exact density cannot be traced along paths", without),
                         "kind = \"exact\" and a formula as rho, or kind = \"none\"");
  if (!without.empty() && !kind && !rho) {
    chosen = "none";
    in.diagnostics.warning(
        in.table("effects." + without)->place,
        fmt::format("with [effects.{}] there is no exact density to compare with, so no errors are measured", without),
        "[reference] kind = \"exact\" compares with a formula, kind = \"none\" says that this is meant");
  }
  const bool reacts = tracers_react(spec);
  if (reacts && kind && chosen == "characteristics")
    in.diagnostics.error(
        kind->value.place,
        "kind = \"characteristics\" does not go with reactions of named densities: paths know their sum "
        "only where nothing is made or lost",
        "kind = \"none\"; [[density]] exact = \"...\" gives the exact density of each");
  if (reacts && !kind && !rho) chosen = "none";
  const Entry* source = spec.sources.empty() ? nullptr : in.top("source");
  if (source && kind && chosen == "characteristics" && without.empty())
    in.diagnostics.error(
        kind->value.place,
        "kind = \"characteristics\" does not go with [[source]]: paths that are traced back to the start "
        "do not meet what enters later",
        "kind = \"exact\" and a formula as rho, or kind = \"none\"");
  if (source && !kind && !rho && without.empty() && !reacts) {
    chosen = "none";
    in.diagnostics.warning(
        source->place, "with [[source]] there is no exact density to compare with, so no errors are measured",
        "[reference] kind = \"exact\" compares with a formula, kind = \"none\" says that this is meant");
  }
  if (const std::string data = read_on_the_way(spec); !data.empty() && chosen == "characteristics") {
    const std::string why =
        fmt::format("{} is too long to be held, and every path of an exact density would read it again", data);
    constexpr const char* remedy = "kind = \"none\" leaves the exact density out; or take fewer times or points";
    if (kind)
      in.diagnostics.error(kind->value.place, why, remedy);
    else
      in.diagnostics.warning(in.table("velocity") ? in.table("velocity")->place : in.source.end(),
                             why + ", so no errors are measured", remedy);
    chosen = "none";
  }
  const auto index = std::find(key.choices.begin(), key.choices.end(), chosen) - key.choices.begin();
  reference.kind = static_cast<ReferenceSpec::Kind>(index);
  if (reference.kind == ReferenceSpec::Kind::exact && !rho && !in.is_meant("reference.rho"))
    in.diagnostics.error(kind->value.place, "kind = \"exact\" needs the exact density as \"rho\"",
                         "rho = \"...\": an expression in x, y, z, t and the params");
  if (rho && reference.kind != ReferenceSpec::Kind::exact)
    in.diagnostics.error(rho->place, fmt::format("\"rho\" goes with kind = \"exact\", not with \"{}\"", chosen));
  if (rho) reference.rho = in.field_expression(rho->value, "reference.rho", true);
  const Entry *points = in.find("reference", "points"), *images = in.find("output", "images");
  if (const auto most = in.number("reference", "points")) reference.points = to_int(*most);
  const bool none = reference.kind == ReferenceSpec::Kind::none;
  if (points && none) in.diagnostics.error(points->place, "\"points\" has no meaning where reference.kind is \"none\"");
  if (!images || (!none && !points)) return;
  for (const Value& item : images->value.items)
    if (item.kind == Kind::text && shows_error(item.text))
      in.diagnostics.error(
          item.place,
          fmt::format("the picture \"{}\" needs {}", item.text,
                      none ? "an exact density, but reference.kind is \"none\""
                           : "the whole grid, but reference.points takes a sample"),
          none ? "leave out reference.kind, or the picture" : "leave out reference.points, or the picture");
}

void write_reference(Writer& out, const ReferenceSpec& reference) {
  out.table("reference");
  out.entry("kind", written_choice(find_key("reference", "kind"), reference.kind));
  if (reference.kind == ReferenceSpec::Kind::exact) out.entry("rho", written(reference.rho));
  if (reference.points) out.entry("points", fmt::format("{}", *reference.points));
}

}  // namespace gaussdrift::input
