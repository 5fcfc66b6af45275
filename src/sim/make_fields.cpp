#include "sim/make_fields.hpp"

#include <algorithm>
#include <array>
#include <utility>
#include <variant>
#include <vector>

#include "field/density/shapes.hpp"
#include "field/gaussians/gaussian_velocity.hpp"
#include "field/gridded/gridded.hpp"
#include "field/named/named_fields.hpp"
#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

namespace {

Box box_of(const Domain& domain) { return {domain.dimension, domain.min, domain.max}; }

std::unique_ptr<VelocityField> make_part(const ExpressionVelocity& spec, const Case& description, int /*threads*/) {
  return std::make_unique<ExpressionField>(spec.components, description.params);
}

std::unique_ptr<VelocityField> make_part(const StreamfunctionVelocity& spec, const Case& description, int /*threads*/) {
  return std::make_unique<StreamfunctionField>(spec.psi, description.params);
}

std::unique_ptr<VelocityField> make_part(const NamedVelocity& spec, const Case& description, int /*threads*/) {
  return make_named_field(spec.field, box_of(description.domain), spec.arguments);
}

/// The choice of that name; the case is valid.
template <class Choice, std::size_t n>
Choice named_choice(const std::array<std::string_view, n>& names, const std::string& name) {
  return static_cast<Choice>(std::find(names.begin(), names.end(), name) - names.begin());
}

template <class FileSpec>
GridInterpolator interpolator(const FileSpec& spec) {
  return {spec.data, named_choice<Interpolation>(interpolation_names, spec.interpolation),
          named_choice<Outside>(outside_names, spec.outside)};
}

std::unique_ptr<VelocityField> make_part(const FileVelocity& spec, const Case& /*description*/, int /*threads*/) {
  return std::make_unique<GriddedVelocity>(interpolator(spec));
}

std::unique_ptr<VelocityField> make_part(const GaussianVelocitySpec& spec, const Case& description, int threads) {
  const Domain& domain = description.domain;
  const Lattice seeding = make_lattice(domain.dimension, domain.min, domain.max, description.particles.per_axis);
  return make_gaussian_velocity(*spec.model, seeding.size(), threads);
}

std::unique_ptr<InitialDensity> make_part(const FileDensity& spec, const Case& /*description*/, int /*threads*/) {
  return std::make_unique<GriddedDensity>(interpolator(spec));
}

std::unique_ptr<InitialDensity> make_part(const ExpressionDensity& spec, const Case& description, int /*threads*/) {
  return std::make_unique<WrittenDensity>(spec.text, description.domain.dimension, description.params);
}

std::unique_ptr<InitialDensity> make_part(const ShapeDensity& spec, const Case& description, int /*threads*/) {
  const NamedShape& shape = find_named_shape(spec.shape);
  return shape.make(description.domain.dimension, complete(shape.about, spec.arguments, box_of(description.domain)));
}

/// The parts of a case; Sum adds several up.
template <class Sum, class Part, class Spec>
std::unique_ptr<Part> make_sum(const std::vector<Spec>& specs, const Case& description, int threads) {
  std::vector<std::unique_ptr<Part>> parts;
  for (const Spec& spec : specs)
    parts.push_back(std::visit([&](const auto& one) { return make_part(one, description, threads); }, spec));
  if (parts.size() == 1) return std::move(parts.front());
  return std::make_unique<Sum>(std::move(parts));
}

}  // namespace

std::unique_ptr<VelocityField> make_velocity(const Case& description, int threads) {
  return make_sum<SumField, VelocityField>(description.velocity, description, threads);
}

std::unique_ptr<InitialDensity> make_density(const Case& description) {
  return make_sum<SumDensity, InitialDensity>(description.density, description, 1);
}

}  // namespace gaussdrift
