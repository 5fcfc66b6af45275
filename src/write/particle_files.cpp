// The particles with their weights and velocities: points of ParaView.
#include "write/output_files.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::write {

namespace {

// Three coordinates, three components of the velocity, weight, id, and two numbers that make each a cell.
double bytes(const Extent& extent) { return bytes_as_text(10) * extent.particles + 2500; }

}  // namespace

FileKind particle_files() {
  return {.about = {.name = "particles",
                    .meaning = "the particles with their weights and velocities",
                    .by_default = true,
                    .needs_velocity = true},
          .ending = ".vtp",
          .text = [](const std::filesystem::path& file,
                     const Frame& frame) { return particle_text(file, *frame.particles, *frame.velocity, frame.time); },
          .bytes = bytes,
          // Eight numbers a particle as arrays, and all as text.
          .memory = [](const Extent& extent) { return 64 * extent.particles + 2.2 * bytes(extent); },
          .view = [](int) { return std::string("Show(particles, view)\n"); }};
}

}  // namespace gaussdrift::write
