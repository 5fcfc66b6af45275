#include "field/density/shapes.hpp"

#include <stdexcept>
#include <string>

#include "field/density/box_density.hpp"
#include "field/density/radial_density.hpp"

namespace gaussdrift {

NamedShape slotted_disk();  // in a file of its name

namespace {

using Kind = NamedParameter::Kind;

const NamedParameter center{.name = "center", .kind = Kind::point, .unit = "length", .meaning = "centre of the shape"};
const NamedParameter radius{.name = "radius", .range = positive, .unit = "length", .meaning = "radius of the shape"};
const NamedParameter height{.name = "height", .fallback = "1", .meaning = "density at the centre"};

NamedShape radial(std::string_view name, RadialDensity::Profile profile, std::string_view meaning,
                  std::string_view formula) {
  return {NamedFormula{.name = name, .meaning = meaning, .formula = formula, .parameters = {center, radius, height}},
          [profile](int dimension, const Arguments& arguments) {
            return std::make_unique<RadialDensity>(profile, dimension, point(arguments, "center"),
                                                   number(arguments, "radius"), number(arguments, "height"));
          }};
}

NamedShape box() {
  return {NamedFormula{.name = "box",
                       .meaning = "constant inside a rectangle, in 3D inside a cuboid. It jumps at the edge",
                       .formula = "height where |x_k - center_k| < lengths_k / 2 on every axis k, else 0",
                       .parameters = {center,
                                      {.name = "lengths",
                                       .kind = Kind::point,
                                       .range = positive,
                                       .unit = "length",
                                       .meaning = "length of each side"},
                                      {.name = "height", .fallback = "1", .meaning = "density inside"}}},
          [](int dimension, const Arguments& a) {
            return std::make_unique<BoxDensity>(dimension, point(a, "center"), point(a, "lengths"),
                                                number(a, "height"));
          }};
}

}  // namespace

const std::vector<NamedShape>& named_shapes() { return base::catalogue<NamedShape>(); }

const NamedShape& find_named_shape(std::string_view name) {
  for (const NamedShape& shape : named_shapes())
    if (shape.about.name == name) return shape;
  throw std::out_of_range("no shape is named " + std::string(name));
}

}  // namespace gaussdrift

namespace gaussdrift::base {

template <>
std::vector<NamedShape>& catalogue() {
  using Profile = RadialDensity::Profile;
  static std::vector<NamedShape> all = {
      radial("wendland", Profile::wendland, "Wendland's function: twice continuously differentiable",
             "height (1 - s)^4 (4 s + 1) for s < 1, else 0, with s = |x - center| / radius"),
      radial("wendland4", Profile::wendland4, "Wendland's function, four times continuously differentiable",
             "height (1 - s)^6 (35 s^2 + 18 s + 3) / 3 for s < 1, else 0, with s = |x - center| / radius"),
      radial("wendland6", Profile::wendland6, "Wendland's function, six times continuously differentiable",
             "height (1 - s)^8 (32 s^3 + 25 s^2 + 8 s + 1) for s < 1, else 0, with s = |x - center| / radius"),
      radial("cone", Profile::cone, "a straight cone. It is continuous and has a kink at the tip and at the edge",
             "height (1 - s) for s < 1, else 0, with s = |x - center| / radius"),
      radial("gaussian", Profile::gaussian,
             "a Gaussian. It is smooth and has no edge: particles start wherever it is not 0",
             "height exp(-s^2), with s = |x - center| / radius"),
      radial("cosine_bell", Profile::cosine_bell, "a bell made of a cosine, once continuously differentiable",
             "height (1 + cos(pi s)) / 2 for s < 1, else 0, with s = |x - center| / radius"),
      radial("disk", Profile::disk, "constant inside a circle, in 3D inside a ball. It jumps at the edge",
             "height for s < 1, else 0, with s = |x - center| / radius"),
      slotted_disk(),
      box(),
  };
  return all;
}

}  // namespace gaussdrift::base
