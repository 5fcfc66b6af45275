// [density]: the density at the start.

#include "field/density/shapes.hpp"
#include "input/tables/tables.hpp"

namespace gaussdrift::input {

void read_density(Reader& in, std::vector<DensitySpec>& density) {
  in.each_part("density", [&](std::string_view kind, const Value& value) {
    const Key& key = find_key("density", kind);
    if (kind == "expression")
      density.emplace_back(ExpressionDensity{in.field_expression(value, in.label_of(key), false)});
    if (kind == "file") density.emplace_back(grid_file<FileDensity>(in, "density", value, 1, 1));
    if (kind == "shape")
      density.emplace_back(ShapeDensity{value.text, in.arguments(key, find_named_shape(value.text).about, value)});
  });
}

}  // namespace gaussdrift::input
