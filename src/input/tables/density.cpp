// [density]: the density at the start.

#include "field/density/shapes.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

Section density_section() {
  std::vector<Key> keys{
      {.name = "expression", .type = Type::expression, .symbol = "rho_0", .meaning = "the density when the run begins"},
      {.name = "shape",
       .type = Type::choice,
       .choices = base::names_of(named_shapes()),
       .meaning = "name of a shape. Its parameters stand beside it"}};
  add_parameters(keys, "shape", named_shapes());
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

void read_density(Reader& in, std::vector<DensitySpec>& density) {
  in.each_part("density", [&](std::string_view kind, const Value& value) {
    const Key& key = find_key("density", kind);
    if (kind == "expression")
      density.emplace_back(ExpressionDensitySpec{in.field_expression(value, in.label_of(key), false)});
    if (kind == "file") density.emplace_back(grid_file<FileDensitySpec>(in, "density", value, 1, 1));
    if (kind == "samples") density.emplace_back(sampled_density(in, value));
    if (kind == "shape")
      density.emplace_back(ShapeDensitySpec{value.text, in.arguments(key, find_named_shape(value.text).about, value)});
  });
}

namespace {

void write_part(Writer& out, const ExpressionDensitySpec& spec) { out.entry("expression", written(spec.text)); }

void write_part(Writer& out, const FileDensitySpec& spec) { write_grid_file(out, spec); }

void write_part(Writer& out, const ShapeDensitySpec& spec) {
  out.entry("shape", written(spec.shape));
  out.arguments("density", spec.shape, spec.arguments);
}

}  // namespace

void write_density(Writer& out, const std::vector<DensitySpec>& density) {
  for (const DensitySpec& part : density) {
    out.part("density", density.size());
    std::visit([&](const auto& spec) { write_part(out, spec); }, part);
  }
}

}  // namespace gaussdrift::input
