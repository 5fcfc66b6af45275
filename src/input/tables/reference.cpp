// [reference]: what every output is compared with.
#include <fmt/format.h>

#include <algorithm>

#include "effect/catalogue.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

using Kind = Value::Kind;

void read_reference(Reader& in, Case& scene) {
  ReferenceSpec& reference = scene.reference;
  const Key& key = find_key("reference", "kind");
  const Entry *kind = in.find("reference", "kind"), *rho = in.find("reference", "rho");
  std::string chosen = in.choice("reference", "kind");
  // With these no path knows the density.
  std::string without;
  for (const auto& [effect, spec] : effects_of(scene.effects))
    if (without.empty() && !effect->keeps_paths()) without = spec.name;
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
    if (item.kind == Kind::text && item.text == "error")
      in.diagnostics.error(
          item.place,
          none ? "the picture \"error\" needs an exact density, but reference.kind is \"none\""
               : "the picture \"error\" needs the whole grid, but reference.points takes a sample",
          none ? "leave out reference.kind, or the picture" : "leave out reference.points, or the picture");
}

}  // namespace gaussdrift::input
