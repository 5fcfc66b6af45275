// The particles with their weights, velocities and core radii: points of ParaView.
#include "write/output_files.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::write {

namespace {

// Three coordinates, three components of the velocity, weight, id, core radius, and two numbers that make each a cell.
double bytes(const Extent& extent) {
  return bytes_as_text(11 + extent.particle_numbers) * extent.particles + 2500 * extent.particle_pieces;
}

// The text, and the core radii. Particles of a piece are brought together before.
double memory(const Extent& extent) {
  const double all = bytes(extent) + 8 * extent.particles;
  return extent.particle_pieces > 1
             ? (all + (272 + 16 * extent.particle_numbers) * extent.particles) / extent.particle_pieces
             : all;
}

}  // namespace

FileKind particle_files() {
  return {
      .about = {.name = "particles",
                .meaning = "the particles with their weights, velocities and core radii",
                .by_default = true,
                .needs_velocity = true},
      .ending = ".vtp",
      .text =
          [](const std::filesystem::path& file, const Frame& frame) {
            return particle_text(file, *frame.particles, *frame.velocity, frame.time, frame.particle_fields,
                                 frame.density->lattice.sphere);
          },
      .particle_piece =
          [](const std::filesystem::path& file, const Frame& frame, const ParticlePiece& piece) {
            return particle_text(file, *piece.particles, *piece.velocity, frame.time, piece.fields,
                                 frame.density->lattice.sphere);
          },
      .index = [](const Frame& frame,
                  const std::vector<std::string>& files) { return particle_index_text(files, frame.particle_fields); },
      .index_ending = ".pvtp",
      .bytes = bytes,
      .memory = memory,
      .view = [](int) { return std::string("show_particles(particles, view)\n"); }};
}

}  // namespace gaussdrift::write
