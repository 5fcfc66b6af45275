// [velocity]: the prescribed velocity.
#include <fmt/format.h>

#include <algorithm>

#include "base/catalogue.hpp"
#include "field/gaussians/gaussian_velocity.hpp"
#include "field/gridded/grid_data.hpp"
#include "field/named/named_fields.hpp"
#include "input/data_files.hpp"
#include "input/sample_table.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

namespace {

std::vector<Key> sample_keys() {
  return {
      samples_key("`x,y[,z],u,v[,w]`"), kernel_key(), width_by_key(),
      Key{.name = "divergence_free",
          .type = Type::boolean,
          .fallback = "false",
          .meaning = "`true`: the field has no divergence, since one matrix kernel stands for all components. It takes "
                     "up to 2000 samples in 2D, 1333 in 3D. `false`: each component has a function of its own",
          .with = "samples"}};
}

std::vector<Key> gaussian_keys() {
  return {
      {.name = "gaussians",
       .meaning = "a table (CSV) of scattered points. The field is a sum of divergence-free Gaussians at these points. "
                  "The path is relative to the case file"},
      {.name = "kind",
       .type = Type::choice,
       .fallback = "velocity",
       .choices = {gaussian_kind_names.begin(), gaussian_kind_names.end()},
       .meaning = "what the table has beside the coordinates `x,y[,z]`. `velocity`: samples `u,v[,w]`, to which the "
                  "field is fitted. `vorticity`: samples `omega` (in 3D `omega_x,omega_y,omega_z`), to which the curl "
                  "of the field is fitted. `coefficients`: the columns `gamma_x,gamma_y[,gamma_z]` of a field that is "
                  "known already. `curl-coefficients`: those of a field that was fitted to a vorticity, in 2D `gamma`",
       .with = "gaussians"},
      {.name = "width",
       .type = Type::number,
       .fallback = "",
       .range = positive,
       .unit = "length",
       .symbol = "1/sqrt(sigma)",
       .meaning = "width of the Gaussians exp(-r^2/width^2). Without it, twice the average spacing of the points. Of "
                  "samples: width c of the kernel, without it chosen as `width_by` says",
       .with = "gaussians",
       .or_with = "samples"},
      {.name = "residual",
       .type = Type::number,
       .fallback = "1e-6",
       .range = {1e-12, 1, false, true},
       .meaning = "accuracy of the fit: the part of the samples that it may leave, in the Euclidean norm",
       .with = "gaussians"},
      {.name = "regularisation",
       .type = Type::number,
       .fallback = "",
       .range = {0, infinity},
       .meaning =
           "how much the fit smooths. The diagonal of its matrix is enlarged by this part. With 0 the field "
           "passes through all samples. Without this key it is 0. Where Gaussians can hardly be told apart, it "
           "is then the smallest of 1e-12, 1e-10, 1e-8 and 1e-6 with which the fit succeeds. Of samples: added to the "
           "diagonal, in units of the kernel, 0 by default",
       .with = "gaussians",
       .or_with = "samples"},
      {.name = "tolerance",
       .type = Type::number,
       .fallback = "1e-8",
       .range = {1e-14, 1, false, true},
       .meaning = "error allowed in the sum of the Gaussians, relative to the largest velocity at the points",
       .with = "gaussians"}};
}

}  // namespace

Section velocity_section() {
  std::vector<Key> keys{
      {.name = "u",
       .type = Type::expressions,
       .unit = "length / time",
       .symbol = "u",
       .meaning = "the velocity: one expression for each axis"},
      {.name = "streamfunction",
       .type = Type::expression,
       .unit = "length^2 / time",
       .symbol = "psi",
       .meaning =
           "in 2D: the function psi with u = (d psi/dy, -d psi/dx). Its derivatives are exact, so the divergence is 0"},
      {.name = "field",
       .type = Type::choice,
       .choices = base::names_of(named_fields()),
       .meaning = "name of a velocity field. Its parameters stand beside it"}};
  add_parameters(keys, "field", named_fields());
  keys.push_back(
      {.name = "file",
       .meaning =
           "a file of ParaView with the velocity on a grid (.vti, .pvti, .vtr, .vts, legacy .vtk, or .pvd for several "
           "times), or of NetCDF (.nc), whose name may stand for several files: wind_*.nc. The path is relative "
           "to the case file"});
  std::vector<Key> of_file = grid_file_keys(
      "error",
      "what to do where the file has no value. `land`: there is no fluid, and `domain.coast` says what happens to "
      "particles that come there. `error` refuses the file, `zero` puts a velocity of 0 there, `nearest` "
      "takes the mean of the nearest points that have a value, `keep` takes every number as it is. A value "
      "is missing if it is not finite, if `vtkGhostType` or `vtkValidPointMask` hides it, or if "
      "`_FillValue` or `missing_value` of its array names it. Numbers that programs use as a mark, such as "
      "1e20 or -9999, and numbers far outside the rest are missing too");
  of_file.insert(of_file.begin() + 1, arrays_key());
  const auto missing =
      std::find_if(of_file.begin(), of_file.end(), [](const Key& key) { return key.name == "missing"; });
  missing->fallback = "land";
  missing->choices.insert(missing->choices.begin(), "land");
  for (const std::vector<Key>& more : {of_file, gaussian_keys(), sample_keys()})
    keys.insert(keys.end(), more.begin(), more.end());
  return {Table{.name = "velocity",
                .required = true,
                .meaning = "the prescribed velocity u. Several `[[velocity]]` add up",
                .kinds = {"u", "streamfunction", "field", "file", "gaussians", "samples"}},
          keys};
}

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
  spec.file = find_data_file(in.folder, value.text);
  try {
    const SampleTable table =
        read_sample_table(spec.file, gaussian_columns_of(options.kind, in.facts.dimension), in.facts.dimension,
                          is_fitted(options.kind) ? Coinciding::refused : Coinciding::allowed);
    spec.model = std::make_shared<const GaussianModel>(
        make_gaussian_model(in.facts.dimension, table.positions, table.values, options));
    spec.regularisation = spec.model->regularisation;
  } catch (const Error& error) {
    in.diagnostics.error(value.place, error.what(), where_data_file_was(in.folder, value.text));
  }
  return spec;
}

StreamfunctionVelocitySpec streamfunction(Reader& in, const Value& value) {
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

ExpressionVelocitySpec expression_velocity(Reader& in, const Value& value) {
  const Key& key = find_key("velocity", "u");
  const std::string label = in.label_of(key);
  ExpressionVelocitySpec field;
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

namespace {

void warn_of_no_land(Reader& in, const std::vector<VelocitySpec>& velocity) {
  const Entry* coast = in.find("domain", "coast");
  if (!coast || in.diagnostics.errors() > 0) return;
  for (const VelocitySpec& part : velocity)
    if (const auto* file = std::get_if<FileVelocitySpec>(&part); file && file->data->land) return;
  in.diagnostics.warning(coast->place, "domain.coast has no effect: there is no land",
                         "land is where a velocity in a file has no values, with missing = \"land\"");
}

}  // namespace

void read_velocity(Reader& in, std::vector<VelocitySpec>& velocity) {
  in.each_part("velocity", [&](std::string_view kind, const Value& value) {
    if (kind == "u") velocity.emplace_back(expression_velocity(in, value));
    if (kind == "file")
      velocity.emplace_back(grid_file<FileVelocitySpec>(in, "velocity", value, in.facts.dimension, 3));
    if (kind == "gaussians") velocity.emplace_back(gaussians(in, value));
    if (kind == "samples") velocity.emplace_back(sampled_velocity(in, value));
    if (kind == "streamfunction") velocity.emplace_back(streamfunction(in, value));
    if (kind == "field")
      velocity.emplace_back(NamedVelocitySpec{
          value.text, in.arguments(find_key("velocity", kind), find_named_field(value.text).about, value)});
  });
  warn_of_no_land(in, velocity);
}

namespace {

void write_part(Writer& out, const ExpressionVelocitySpec& spec) { out.entry("u", written(spec.components)); }

void write_part(Writer& out, const StreamfunctionVelocitySpec& spec) { out.entry("streamfunction", written(spec.psi)); }

void write_part(Writer& out, const FileVelocitySpec& spec) { write_grid_file(out, spec); }

void write_part(Writer& out, const GaussianVelocitySpec& spec) {
  out.entry("gaussians", out.data_file(spec.file));
  out.entry("kind", written(spec.kind));
  out.entry("width", written(spec.model->width));
  if (spec.residual > 0) out.entry("residual", written(spec.residual));
  if (spec.residual > 0) out.entry("regularisation", written(spec.regularisation));
  out.entry("tolerance", written(spec.tolerance));
}

void write_part(Writer& out, const NamedVelocitySpec& spec) {
  out.entry("field", written(spec.field));
  out.arguments("velocity", spec.field, spec.arguments);
}

}  // namespace

void write_velocity(Writer& out, const std::vector<VelocitySpec>& velocity) {
  for (const VelocitySpec& part : velocity) {
    out.part("velocity", velocity.size());
    std::visit([&](const auto& spec) { write_part(out, spec); }, part);
  }
}

}  // namespace gaussdrift::input
