#include "sim/make_fields.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>
#include <vector>

#include "base/longest_side.hpp"
#include "field/density/shapes.hpp"
#include "field/density/sum_density.hpp"
#include "field/density/written_density.hpp"
#include "field/folded/folded.hpp"
#include "field/gaussians/gaussian_velocity.hpp"
#include "field/gridded/gridded.hpp"
#include "field/gridded/land.hpp"
#include "field/named/named_fields.hpp"
#include "field/samples/sampled_density.hpp"
#include "field/samples/sampled_velocity.hpp"
#include "field/spherical/around_centre.hpp"
#include "field/spherical/on_sphere.hpp"
#include "field/velocity/expression_field.hpp"
#include "field/velocity/streamfunction_field.hpp"
#include "field/velocity/sum_field.hpp"
#include "gaussdrift/lattice.hpp"
#include "sim/borders/edges.hpp"

namespace gaussdrift {

namespace {

Box box_of(const Domain& domain) { return {domain.dimension, domain.min, domain.max}; }

/// As particles are carried: on a sphere in degrees per time.
std::unique_ptr<VelocityField> in_coordinates(std::unique_ptr<VelocityField> part, const Case& spec,
                                              DegreesVelocity::Of kind = DegreesVelocity::Of::components) {
  if (!spec.domain.on_sphere()) return part;
  return std::make_unique<DegreesVelocity>(std::move(part), kind, spec.domain.sphere);
}

std::unique_ptr<VelocityField> make_part(const ExpressionVelocitySpec& part, const Case& spec, int /*threads*/) {
  return in_coordinates(std::make_unique<ExpressionField>(part.components, spec.params), spec);
}

std::unique_ptr<VelocityField> make_part(const StreamfunctionVelocitySpec& part, const Case& spec, int /*threads*/) {
  return in_coordinates(
      std::make_unique<StreamfunctionField>(part.psi, spec.params,
                                            longest_side(spec.domain.dimension, spec.domain.min, spec.domain.max)),
      spec, DegreesVelocity::Of::streamfunction);
}

std::unique_ptr<VelocityField> make_part(const NamedVelocitySpec& part, const Case& spec, int /*threads*/) {
  return make_named_field(part.field, box_of(spec.domain), part.arguments);
}

/// The choice of that name; the case is valid.
template <class Choice, std::size_t n>
Choice named_choice(const std::array<std::string_view, n>& names, const std::string& name) {
  return static_cast<Choice>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <class FileSpec>
GridInterpolator interpolator(const FileSpec& part) {
  return {part.data, named_choice<Interpolation>(interpolation_names, part.interpolation),
          named_choice<Outside>(outside_names, part.outside),
          named_choice<Interpolation>(interpolation_names, part.time_interpolation)};
}

std::unique_ptr<VelocityField> make_part(const FileVelocitySpec& part, const Case& spec, int /*threads*/) {
  if (part.data->land)
    return in_coordinates(
        std::make_unique<CoastalVelocity>(interpolator(part), outside_of(part), spec.domain.coast != AtCoast::refuse),
        spec);
  return in_coordinates(std::make_unique<GriddedVelocity>(interpolator(part)), spec);
}

/// Most particles that there may be at the start: points at which a velocity is evaluated at once.
std::size_t most_particles(const Case& spec) { return seeding_lattice(spec.domain, spec.particles.per_axis).size(); }

std::unique_ptr<VelocityField> make_part(const GaussianVelocitySpec& part, const Case& spec, int threads) {
  return make_gaussian_velocity(*part.model, most_particles(spec), threads);
}

std::unique_ptr<VelocityField> make_part(const SamplesVelocitySpec& part, const Case& spec, int /*threads*/) {
  return make_sampled_velocity(part.fit, named_choice<Outside>(outside_names, part.outside), most_particles(spec));
}

std::unique_ptr<InitialDensity> make_part(const SamplesDensitySpec& part, const Case& spec, int /*threads*/) {
  return make_sampled_density(part.fit, named_choice<Outside>(outside_names, part.outside), spec.domain.min,
                              spec.domain.max);
}

std::unique_ptr<InitialDensity> make_part(const FileDensitySpec& part, const Case& spec, int /*threads*/) {
  return std::make_unique<GriddedDensity>(interpolator(part), spec.time.start);
}

std::unique_ptr<InitialDensity> make_part(const ExpressionDensitySpec& part, const Case& spec, int /*threads*/) {
  return std::make_unique<WrittenDensity>(part.text, spec.domain.dimension, spec.params);
}

std::unique_ptr<InitialDensity> make_part(const ShapeDensitySpec& part, const Case& spec, int /*threads*/) {
  const NamedShape& shape = find_named_shape(part.shape);
  Arguments arguments = complete(shape.about, part.arguments, box_of(spec.domain));
  if (!spec.domain.on_sphere()) return shape.make(spec.domain.dimension, arguments);
  const Vector centre = point(arguments, "center");
  for (auto& [name, values] : arguments)
    if (name == "center") values.assign(values.size(), 0.0);
  return std::make_unique<DensityAroundCentre>(shape.make(spec.domain.dimension, arguments), centre,
                                               spec.domain.sphere);
}

/// The parts of a case; Sum adds several up.
template <class Sum, class Part, class Spec>
std::unique_ptr<Part> make_sum(const std::vector<Spec>& specs, const Case& spec, int threads) {
  std::vector<std::unique_ptr<Part>> parts;
  for (const Spec& part : specs)
    parts.push_back(std::visit([&](const auto& one) { return make_part(one, spec, threads); }, part));
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<Sum>(std::move(parts));
}

}  // namespace

namespace {

/// The velocity has no divergence on the sphere, by construction.
bool keeps_areas_of_sphere(const Case& spec) {
  return std::all_of(spec.velocity.begin(), spec.velocity.end(), [](const VelocitySpec& part) {
    return std::holds_alternative<StreamfunctionVelocitySpec>(part) || std::holds_alternative<NamedVelocitySpec>(part);
  });
}

}  // namespace

Clock clock_of(const TimeSpec& time) { return {.start = time.start, .backwards = time.backwards}; }

Outside outside_of(const FileVelocitySpec& part) { return named_choice<Outside>(outside_names, part.outside); }

std::unique_ptr<VelocityField> make_velocity(const Case& spec, int threads, std::vector<std::string>* misfits) {
  auto velocity = make_sum<SumField, VelocityField>(spec.velocity, spec, threads);
  if (const Folding folding = folding_of(spec.domain); folding.folds()) {
    std::vector<std::string> words = misfits_at_faces(*velocity, spec.domain, spec.time);
    const bool smooth = words.empty();
    if (misfits) *misfits = std::move(words);
    velocity = std::make_unique<FoldedVelocity>(std::move(velocity), folding, smooth);
  }
  if (!spec.time.is_plain()) velocity = std::make_unique<ClockedVelocity>(std::move(velocity), clock_of(spec.time));
  if (spec.domain.on_sphere())
    velocity = std::make_unique<SphereVelocity>(std::move(velocity), spec.domain.sphere, keeps_areas_of_sphere(spec));
  return velocity;
}

namespace {

std::unique_ptr<InitialDensity> folded(std::unique_ptr<InitialDensity> density, const Case& spec) {
  const Folding folding = folding_of(spec.domain);
  if (!folding.folds()) return density;
  return std::make_unique<FoldedDensity>(std::move(density), folding);
}

}  // namespace

std::unique_ptr<InitialDensity> make_density(const Case& spec) {
  return folded(make_sum<SumDensity, InitialDensity>(spec.density, spec, 1), spec);
}

std::unique_ptr<InitialDensity> make_density(const Case& spec, const TracerSpec& tracer) {
  std::vector<DensitySpec> parts;
  for (const std::size_t part : tracer.parts) parts.push_back(spec.density[part]);
  return folded(make_sum<SumDensity, InitialDensity>(parts, spec, 1), spec);
}

std::unique_ptr<InitialDensity> make_density(const Case& spec, const ShapeDensitySpec& shape) {
  return folded(make_part(shape, spec, 1), spec);
}

namespace {

std::unique_ptr<ScalarField> folded(std::unique_ptr<ScalarField> field, const Case& spec) {
  const Folding folding = folding_of(spec.domain);
  if (!folding.folds()) return field;
  return std::make_unique<FoldedScalar>(std::move(field), folding);
}

std::unique_ptr<ScalarField> on_the_clock(std::unique_ptr<ScalarField> field, const Case& spec) {
  if (spec.time.is_plain()) return field;
  return std::make_unique<ClockedRate>(std::move(field), clock_of(spec.time));
}

}  // namespace

std::unique_ptr<ScalarField> make_scalar(const Case& spec, const std::string& text) {
  return folded(std::make_unique<WrittenScalar>(text, spec.domain.dimension, spec.params), spec);
}

std::unique_ptr<ScalarField> make_rate(const Case& spec, const std::string& text) {
  return on_the_clock(make_scalar(spec, text), spec);
}

std::unique_ptr<ScalarField> make_rate(const Case& spec, const GridFileSpec& file) {
  return on_the_clock(folded(std::make_unique<GriddedScalar>(interpolator(file)), spec), spec);
}

}  // namespace gaussdrift
