// .vti, .vtr, .vts, .pvti and legacy .vtk, numbers of a .csv and pictures: all their arrays, as velocities, densities and results of a run.
#include "fuzz_target.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift {

namespace {

template <class Work>
void answered(const Work& work) {
  try {
    work();
  } catch (const read::GridFileError&) {
  }
}

}  // namespace

FUZZ_TARGET(grid) {
  const bool rectilinear = text.find("<RectilinearGrid") != std::string_view::npos;
  const auto has = [&](std::string_view word) { return text.find(word) != std::string_view::npos; };
  const std::string kind = has("# vtk DataFile")        ? ".vtk"
                           : has("<PImageData")         ? ".pvti"
                           : has("<StructuredGrid")     ? ".vts"
                           : rectilinear                ? ".vtr"
                           : text.starts_with("\x89PN") ? ".png"
                           : has("<")                   ? ".vti"
                                                        : ".csv";
  const std::filesystem::path file = fuzz::folder().write("grid" + kind, text);
  if (kind == ".csv" || kind == ".png")
    return answered([&] { read::read_grid(file, {.frame = read::Frame{{0, 0}, {1, 1}}}); });
  int dimension = 2;
  answered([&] { dimension = read::read_snapshot(file, "rho").dimension; });
  answered([&] { read::read_grid(file, {.arrays = {"u"}, .dimension = dimension, .most_components = 3}); });
  answered([&] {
    read::read_grid(file, {.dimension = dimension, .most_components = 3, .missing = read::Missing::nearest});
  });
}

}  // namespace gaussdrift
