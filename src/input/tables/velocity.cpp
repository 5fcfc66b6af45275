// [velocity]: the prescribed velocity.
#include <fmt/format.h>

#include <algorithm>

#include "field/gaussians/gaussian_velocity.hpp"
#include "field/named/named_fields.hpp"
#include "input/gaussian_table.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

using Kind = Value::Kind;

namespace {

/// Divergence-free Gaussians, read and fitted at once so that everything wrong with them has its place in the case
/// file.
GaussianVelocitySpec gaussians(Reader& in, const Value& value) {
  const int errors_before = in.diagnostics.errors();
  GaussianVelocitySpec spec;
  spec.kind = in.choice("velocity", "kind");
  const auto named = std::find(gaussian_kind_names.begin(), gaussian_kind_names.end(), spec.kind);
  GaussianModelOptions options;
  options.kind = static_cast<GaussianKind>(named - gaussian_kind_names.begin());
  options.fit.threads = in.threads;
  if (const auto width = in.number("velocity", "width")) options.width = width->number;
  if (const auto tolerance = in.number("velocity", "tolerance")) spec.tolerance = options.tolerance = tolerance->number;
  if (is_fitted(options.kind)) {
    if (const auto residual = in.number("velocity", "residual"))
      spec.residual = options.fit.residual = residual->number;
    if (const auto lambda = in.number("velocity", "regularisation"))
      options.fit.regularisation = lambda->number;
    else
      options.regularise = true;
  } else {
    for (const char* key : {"residual", "regularisation"})
      if (const Entry* entry = in.find("velocity", key))
        in.diagnostics.error(entry->place,
                             fmt::format("\"{}\" is for fits to samples; kind = \"{}\" takes coefficients as "
                                         "they are",
                                         key, spec.kind));
  }
  if (value.kind != Kind::text)
    in.wrong_type(value, in.label_of(find_key("velocity", "gaussians")), "the name of a file in a string");
  if (!in.facts.dimension || in.diagnostics.errors() > errors_before) return spec;
  spec.file = std::filesystem::absolute(in.folder / value.text).lexically_normal();
  try {
    const GaussianTable table = read_gaussian_table(spec.file, options.kind, in.facts.dimension);
    spec.model = std::make_shared<const GaussianModel>(
        make_gaussian_model(in.facts.dimension, table.positions, table.values, options));
    spec.regularisation = spec.model->regularisation;
  } catch (const Error& error) {
    in.diagnostics.error(value.place, error.what());
  }
  return spec;
}

StreamfunctionVelocity streamfunction(Reader& in, const Value& value) {
  const std::string label = in.label_of(find_key("velocity", "streamfunction"));
  if (in.facts.dimension == 3)
    in.diagnostics.error(value.place, fmt::format("{} exists only in 2D; the domain has 3 dimensions", label),
                         "in 3D write u = [...]");
  const int errors_before = in.diagnostics.errors();
  const std::string psi = in.field_expression(value, label, true);
  if (in.diagnostics.errors() > errors_before || in.facts.dimension != 2) return {psi};
  for (const RoughSpot& spot : Expression(psi, {"x", "y", "t"}, in.constants()).rough_spots()) {
    const std::size_t at = spot.name.empty() ? std::string::npos : psi.find(spot.name);
    in.diagnostics.warning(
        at == std::string::npos ? value.place : place_in_text(value, in.source, at, spot.name.size()),
        fmt::format("the streamfunction has no derivative everywhere: {}", spot.taken),
        "the velocity is its derivative; it is right where particles do not meet such a place");
  }
  return {psi};
}

ExpressionVelocity expression_velocity(Reader& in, const Value& value) {
  const Key& key = find_key("velocity", "u");
  const std::string label = in.label_of(key);
  ExpressionVelocity field;
  if (value.kind != Kind::list) {
    in.wrong_type(value, label, type_text(key));
    return field;
  }
  if (in.facts.dimension) in.has_entries(value, key, "expression");
  for (std::size_t k = 0; k < value.items.size(); ++k)
    field.components.push_back(in.field_expression(value.items[k], fmt::format("entry {} of {}", k + 1, label), true));
  return field;
}

}  // namespace

void read_velocity(Reader& in, std::vector<VelocitySpec>& velocity) {
  in.each_part("velocity", [&](std::string_view kind, const Value& value) {
    if (kind == "u") velocity.emplace_back(expression_velocity(in, value));
    if (kind == "file") velocity.emplace_back(grid_file<FileVelocity>(in, "velocity", value, in.facts.dimension, 3));
    if (kind == "gaussians") velocity.emplace_back(gaussians(in, value));
    if (kind == "streamfunction") velocity.emplace_back(streamfunction(in, value));
    if (kind == "field")
      velocity.emplace_back(NamedVelocity{
          value.text, in.arguments(find_key("velocity", kind), find_named_field(value.text).about, value)});
  });
}

}  // namespace gaussdrift::input
