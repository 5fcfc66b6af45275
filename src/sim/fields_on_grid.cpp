#include "sim/fields_on_grid.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "base/parallel.hpp"
#include "sim/flow_on_block.hpp"
#include "sim/follow/particle_fields.hpp"
#include "sim/grid_fields.hpp"

namespace gaussdrift {

bool shows_fields(const OutputSpec& output) { return !fields_beside_density(output).empty(); }

int field_numbers(const OutputSpec& output, int dimension) {
  int numbers = 0;
  for (const GridFieldKind* kind : fields_beside_density(output)) numbers += kind->components(dimension) > 1 ? 3 : 1;
  return numbers + static_cast<int>(particle_fields_on_grid(output).size());
}

std::vector<DensityDerivatives> derivatives_of(const OutputSpec& output, int dimension) {
  std::vector<DensityDerivatives> all;
  for (const GridFieldKind* kind : fields_beside_density(output))
    if (kind->of_density)
      for (DensityDerivatives& component : kind->of_density(dimension)) all.push_back(std::move(component));
  return all;
}

std::vector<FieldOnGrid> fields_on_grid(const OutputSpec& output, const Lattice& lattice, const LatticeBox& box,
                                        const std::vector<std::vector<double>>& derivatives,
                                        const VelocityField& velocity, double t, int threads) {
  const int d = lattice.dimension;
  const std::size_t count = box.size();
  std::vector<FieldOnGrid> fields;
  const std::vector<const GridFieldKind*> kinds = fields_beside_density(output);
  fields.reserve(kinds.size());
  struct OfFlow {
    const GridFieldKind* kind;
    FieldOnGrid* field;
  };
  std::vector<OfFlow> of_flow;
  std::size_t next = 0;
  for (const GridFieldKind* kind : kinds) {
    const auto components = static_cast<std::size_t>(kind->components(d));
    FieldOnGrid& field = fields.emplace_back(FieldOnGrid{std::string(kind->about.name), static_cast<int>(components),
                                                         std::vector<double>(count * components)});
    if (kind->of_flow)
      of_flow.push_back({kind, &field});
    else
      for (std::size_t c = 0; c < components; ++c, ++next)
        for (std::size_t j = 0; j < count; ++j) field.values[j * components + c] = derivatives[next][j];
  }
  if (of_flow.empty()) return fields;
  const bool with_gradient =
      std::any_of(of_flow.begin(), of_flow.end(), [](const OfFlow& one) { return one.kind->needs_gradient; });
  const std::size_t block = velocity.evaluates_in_blocks() ? std::min<std::size_t>(512, count) : count;
  constexpr double seconds_of_value = 4e-8;  // of a velocity of cost 1; with its gradient some four times that
  const double seconds = static_cast<double>(count) * seconds_of_value * velocity.cost() * (with_gradient ? 4 : 1);
  const auto evaluate = [&](FlowOnBlock& flow, std::size_t number) {
    const std::size_t first = number * block, length = std::min(block, count - first);
    flow.evaluate(velocity, t, length, [&](std::size_t k, std::size_t j) {
      std::size_t before = 1;
      for (std::size_t axis = 0; axis < k; ++axis) before *= box.points[axis];
      return lattice.coordinate(static_cast<int>(k), box.first[k] + (first + j) / before % box.points[k]);
    });
    for (std::size_t j = 0; j < length; ++j) {
      const FlowThere there = flow.at(j);
      for (const OfFlow& one : of_flow)
        one.kind->of_flow(there,
                          one.field->values.data() + (first + j) * static_cast<std::size_t>(one.field->components));
    }
  };
  base::parallel_for(
      {(count + block - 1) / block, seconds}, threads, [&] { return FlowOnBlock(d, block, with_gradient); }, evaluate);
  return fields;
}

}  // namespace gaussdrift
