// Tracks and fields of the particles of a run: what outputs tell of particles beside where they are.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>
#include <string>

#include "base/has_one.hpp"
#include "gaussdrift/error.hpp"
#include "sim/borders/edges.hpp"
#include "sim/follow/density_at_points.hpp"
#include "sim/follow/particle_fields.hpp"
#include "sim/particle_pieces.hpp"
#include "sim/run_parts.hpp"

namespace gaussdrift {

// `landed`: weights are those of this time.
void Simulation::Parts::look_at_tracks(bool landed) {
  if (!tracks_.wanted()) return;
  on_first([&] { tracks_.follow(leg_, steps_before_, summary_.stages); });
  const Tracks::DensityAt density_at = [&](const std::vector<double>& points) {
    Particles images;
    DensityOptions options = density_options();
    options.derivatives = tracks_.derivatives();
    return density_at_points(images_agreed(images), blob(), options, points, ranks_);
  };
  TrackSamples samples;
  summary_.stages.run("tracks",
                      [&] { samples = tracks_.look(particles_, leg_.now, landed ? density_at : Tracks::DensityAt()); });
  on_first([&] {
    if (samples.size() == 0) return;
    for (const auto& observer : observers) summary_.stages.run(observer->name(), [&] { observer->tracks(samples); });
  });
}

void pass_fields(base::StateBytes& bytes, std::vector<FieldNumbers>& fields) {
  std::uint64_t count = fields.size();
  bytes(count);
  if (count > particle_field_kinds().size()) throw std::out_of_range("there are too many fields of particles");
  fields.resize(count);
  for (FieldNumbers& one : fields) bytes(one.name, one.largest, one.mean, one.values);
}

ParticlesThere Simulation::Parts::there(const Particles& particles, double time) const {
  return {particles, case_.domain, scene_.seeding,
          time,      case_.time,   [this](std::int64_t id) { return releases_.began(id); },
          threads_};
}

bool Simulation::Parts::shows_where_particles_began() const {
  return base::has_one(case_.output.files, &OutputFile::shows_density) &&
         !particle_fields_on_grid(case_.output).empty();
}

// Of the particles of a frame; density files get those that belong to the places where particles began.
std::vector<FieldOnGrid> Simulation::Parts::add_particle_fields(const Frame& frame, DensityGrid& density) const {
  // Where they come in pieces, the file that names these has to know of the arrays.
  const std::vector<FieldOnGrid> besides =
      for_files_of_particles(frame.particle_pieces == 1 ? *frame.particles : Particles());
  if (particle_fields_of(case_.output).empty()) return besides;
  const ParticlesThere here = there(*frame.particles, frame.elapsed);
  std::vector<FieldOnGrid> fields = particle_fields(case_.output, here);
  if (shows_where_particles_began())
    for (FieldOnGrid& field :
         where_particles_began(case_.output, fields, carrier_.memory().gone(), here, scene_.evaluation))
      density.fields.push_back(std::move(field));
  fields.insert(fields.end(), besides.begin(), besides.end());
  return fields;
}

// What files of particles have besides: the radius of the blobs at this time, and the weights of each named density.
std::vector<FieldOnGrid> Simulation::Parts::for_files_of_particles(const Particles& particles) const {
  std::vector<FieldOnGrid> fields;
  if (!base::has_one(case_.output.files, &OutputFile::needs_velocity)) return fields;
  const double radius = std::sqrt(scene_.core_radius * scene_.core_radius + particles_.spread);
  fields.push_back({"core_radius", 1, std::vector<double>(particles.size(), radius)});
  for (std::size_t k = 0; k < case_.tracers.size(); ++k)
    fields.push_back({"alpha_" + case_.tracers[k].name, 1,
                      k < particles.tracers.size() ? particles.tracers[k] : std::vector<double>()});
  return fields;
}

void Simulation::Parts::hand_out_pieces(const Frame& frame, const std::vector<double>& velocity) {
  std::vector<FieldOnGrid> fields;
  ranks_.agree_on([&] {
    fields = particle_fields(case_.output, there(particles_, frame.elapsed));
    for (FieldOnGrid& field : for_files_of_particles(particles_)) fields.push_back(std::move(field));
  });
  hand_out_particles(particles_, velocity, fields, frame.particle_pieces, ranks_, [&](const ParticlePiece& piece) {
    for (const auto& observer : observers) {
      base::seam();
      summary_.stages.run(observer->name(), [&] { observer->particle_piece(frame, piece); });
    }
  });
}

void Simulation::Parts::check_particle_fields() const {
  if (in_pieces() && shows_where_particles_began())
    throw InputError(fmt::format(
        "output.fields names \"{}\", which density files show on a grid that is held as a whole, and this one is "
        "written in {} pieces; raise evaluate.piece_points to {}, or leave \"density\" out of output.vtk",
        particle_fields_on_grid(case_.output).front(), pieces_.count(), scene_.evaluation.size()));
  if (ranks_.size() > 1 && compares_neighbours(case_.output) &&
      pieces_of_particles(particle_count(), case_.output.piece_particles) > 1)
    throw InputError(fmt::format(
        "output.fields names what follows from neighbours on the lattice, and on {} ranks their particles are brought "
        "together on one of them only where one file has all {}; raise output.piece_particles, or start the run on "
        "one rank",
        ranks_.size(), particle_count()));
}

}  // namespace gaussdrift
