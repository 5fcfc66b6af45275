#include "sim/follow/particle_fields.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/nan.hpp"
#include "sim/borders/edges.hpp"
#include "sim/follow/flow_map.hpp"

namespace gaussdrift {

namespace {

using base::nan;

std::vector<double> remembered(const ParticlesThere& there, Kept what) {
  return there.particles.kept[static_cast<std::size_t>(what)];
}

double kept_of(const double* kept, Kept what) { return kept[static_cast<std::size_t>(what)]; }

/// The time of the first exit, where there was one.
double exit_or_nan(double time, double face, const TimeSpec& clock) { return face == 0 ? nan : clock.at(time); }

GridFieldKind age() {
  return {.about = {.name = "age",
                    .meaning = "of the particles: the time since they began, at the start or at their release",
                    .is_of_particles = true,
                    .is_on_grid = false},
          .of_particles = {.values = [](const ParticlesThere& there) {
            std::vector<double> values;
            for (const std::int64_t id : there.particles.id) values.push_back(there.time - there.began(id));
            return values;
          }}};
}

GridFieldKind residence_time() {
  return {
      .about = {.name = "residence_time",
                .meaning = "of the particles: how long they have been inside the domain",
                .is_of_particles = true},
      .of_particles = {.values = [](const ParticlesThere& there) { return remembered(there, Kept::residence); },
                       .of_gone = [](const double* kept, const TimeSpec&) { return kept_of(kept, Kept::residence); },
                       .is_remembered = true}};
}

GridFieldKind exit_time() {
  return {.about = {.name = "exit_time",
                    .meaning = "of the particles: the time at which they left the domain first. It is not a number of "
                               "those that have not",
                    .is_of_particles = true},
          .of_particles = {.values =
                               [](const ParticlesThere& there) {
                                 std::vector<double> values = remembered(there, Kept::exit_time);
                                 const std::vector<double> faces = remembered(there, Kept::exit_face);
                                 for (std::size_t j = 0; j < values.size(); ++j)
                                   values[j] = exit_or_nan(values[j], faces[j], there.clock);
                                 return values;
                               },
                           .of_gone =
                               [](const double* kept, const TimeSpec& clock) {
                                 return exit_or_nan(kept_of(kept, Kept::exit_time), kept_of(kept, Kept::exit_face),
                                                    clock);
                               },
                           .is_remembered = true}};
}

GridFieldKind exit_face() {
  return {
      .about = {.name = "exit_face",
                .meaning = "of the particles: the face through which they left the domain first. 0 is none yet, 1 "
                           "and 2 are the lower and the upper one of x, 3 and 4 of y, 5 and 6 of z",
                .is_of_particles = true},
      .of_particles = {.values = [](const ParticlesThere& there) { return remembered(there, Kept::exit_face); },
                       .of_gone = [](const double* kept, const TimeSpec&) { return kept_of(kept, Kept::exit_face); },
                       .is_remembered = true}};
}

std::vector<double> gradients_of(const ParticlesThere& there) {
  return flow_map_gradients(there.particles, there.lattice, folding_of(there.domain), there.threads);
}

GridFieldKind flow_map_gradient() {
  return {.about = {.name = "flow_map_gradient",
                    .meaning = "of the particles: how their places change with those at which they began, dX_i/dx_k, "
                               "by differences of lattice neighbours",
                    .is_matrix = true,
                    .is_of_particles = true,
                    .is_on_grid = false},
          .of_particles = {.values = gradients_of, .compares_neighbours = true}};
}

GridFieldKind ftle() {
  return {
      .about = {.name = "ftle",
                .meaning = "of the particles: the finite-time Lyapunov exponent, ln(s)/t, where s is the largest "
                           "singular value of `flow_map_gradient` and t the time since the start. It belongs to the "
                           "place where a particle began",
                .is_of_particles = true},
      .of_particles = {.values =
                           [](const ParticlesThere& there) {
                             return lyapunov_exponents(gradients_of(there), there.particles.dimension, there.time,
                                                       there.threads);
                           },
                       .compares_neighbours = true}};
}

template <class Is>
bool some(const OutputSpec& output, const Is& is) {
  const std::vector<const GridFieldKind*> kinds = particle_fields_of(output);
  return std::any_of(kinds.begin(), kinds.end(), [&](const GridFieldKind* kind) { return is(kind->of_particles); });
}

/// The point of the lattice that is nearest to a point of the other one; nothing beyond half a spacing of its ends.
class NearestPoint {
 public:
  NearestPoint(const Lattice& lattice, const Domain& domain) : lattice_(lattice), folding_(folding_of(domain)) {}

  std::size_t of(const Lattice& other, std::size_t point) const {
    std::size_t id = 0, stride = 1;
    for (int k = 0; k < lattice_.dimension; ++k) {
      const auto axis = static_cast<std::size_t>(k);
      const std::size_t here = point % other.points[axis];
      point /= other.points[axis];
      const double place = (other.coordinate(k, here) - lattice_.origin[axis]) / lattice_.spacing;
      // Half way between two points the lower one counts, whatever rounding says.
      double nearest = std::ceil(place - 0.5 - 1e-9);
      const auto points = static_cast<double>(lattice_.points[axis]);
      if (folding_.axis(k).periodic) nearest -= points * std::floor(nearest / points);
      if (nearest == -1 && place > -0.5 - 1e-9) nearest = 0;
      if (nearest < 0 || nearest >= points) return none;
      id += static_cast<std::size_t>(nearest) * stride;
      stride *= lattice_.points[axis];
    }
    return id;
  }

  static constexpr std::size_t none = static_cast<std::size_t>(-1);

 private:
  const Lattice& lattice_;
  Folding folding_;
};

}  // namespace

std::vector<GridFieldKind> particle_field_kinds() {
  return {age(), residence_time(), exit_time(), exit_face(), flow_map_gradient(), ftle()};
}

std::vector<const GridFieldKind*> particle_fields_of(const OutputSpec& output) {
  std::vector<const GridFieldKind*> kinds;
  for (const GridField& field : output.fields)
    if (field.is_of_particles) kinds.push_back(&find_grid_field(field.name));
  return kinds;
}

bool remembers(const OutputSpec& output) {
  return some(output, [](const FieldOfParticles& field) { return field.is_remembered; });
}

bool compares_neighbours(const OutputSpec& output) {
  return some(output, [](const FieldOfParticles& field) { return field.compares_neighbours; });
}

std::vector<std::string> particle_fields_on_grid(const OutputSpec& output) {
  std::vector<std::string> names;
  for (const GridFieldKind* kind : particle_fields_of(output))
    if (kind->about.is_on_grid) names.emplace_back(kind->about.name);
  return names;
}

int particle_field_numbers(const OutputSpec& output) {
  int numbers = 0;
  for (const GridFieldKind* kind : particle_fields_of(output)) numbers += kind->about.is_matrix ? 9 : 1;
  return numbers;
}

std::vector<FieldOnGrid> particle_fields(const OutputSpec& output, const ParticlesThere& there) {
  std::vector<FieldOnGrid> fields;
  for (const GridFieldKind* kind : particle_fields_of(output))
    fields.push_back(
        {std::string(kind->about.name), kind->components(there.particles.dimension), kind->of_particles.values(there)});
  return fields;
}

std::vector<FieldOnGrid> where_particles_began(const OutputSpec& output, const std::vector<FieldOnGrid>& fields,
                                               const std::vector<Gone>& gone, const ParticlesThere& there,
                                               const Lattice& evaluation) {
  std::vector<FieldOnGrid> shown;
  const NearestPoint nearest(there.lattice, there.domain);
  const std::vector<std::int64_t>& id = there.particles.id;
  std::vector<double> on_lattice;
  std::size_t number = 0;
  for (const GridFieldKind* kind : particle_fields_of(output)) {
    const FieldOnGrid& field = fields[number++];
    if (!kind->about.is_on_grid) continue;
    on_lattice.assign(there.lattice.size(), nan);
    for (std::size_t j = 0; j < id.size(); ++j)
      if (static_cast<std::size_t>(id[j]) < on_lattice.size())
        on_lattice[static_cast<std::size_t>(id[j])] = field.values[j];
    if (kind->of_particles.of_gone)
      for (const Gone& one : gone)
        if (static_cast<std::size_t>(one.id) < on_lattice.size())
          on_lattice[static_cast<std::size_t>(one.id)] = kind->of_particles.of_gone(one.kept.data(), there.clock);
    FieldOnGrid& there_shown = shown.emplace_back(FieldOnGrid{field.name, 1, std::vector<double>(evaluation.size())});
    for (std::size_t point = 0; point < there_shown.values.size(); ++point) {
      const std::size_t from = nearest.of(evaluation, point);
      there_shown.values[point] = from == NearestPoint::none ? nan : on_lattice[from];
    }
  }
  return shown;
}

}  // namespace gaussdrift
