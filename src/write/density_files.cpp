// The density on the evaluation lattice, with the exact one and the error where they are known: image data of ParaView.
#include "write/output_files.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::write {

namespace {

double bytes(const Extent& extent) {
  return bytes_as_text(extent.grid_points) * ((extent.compared_everywhere ? 3 : 1) + extent.field_numbers) +
         1500 * extent.pieces;
}

}  // namespace

FileKind density_files() {
  return {.about = {.name = "density",
                    .meaning = "the density on the evaluation lattice, with the exact density and the error where all "
                               "points are compared, and with `output.fields`",
                    .by_default = true,
                    .shows_density = true},
          .ending = ".vti",
          .text = [](const std::filesystem::path& file,
                     const Frame& frame) { return density_text(file, *frame.density, frame.time, frame.exact); },
          .piece = [](const std::filesystem::path& file, const Frame& frame,
                      const DensityPiece& piece) { return density_piece_text(file, frame, piece); },
          .index = density_index_text,
          .index_ending = ".pvti",
          .bytes = bytes,
          .memory = [](const Extent& extent) { return bytes(extent) / extent.pieces; },
          .view = [](int) { return std::string("show_density(density, view)\n"); }};
}

}  // namespace gaussdrift::write
