// .vti and .vtr: all their arrays, as velocities, densities and results of a run.
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
  const std::filesystem::path file = fuzz::folder().write(rectilinear ? "grid.vtr" : "grid.vti", text);
  int dimension = 2;
  answered([&] { dimension = read::read_snapshot(file, "rho").dimension; });
  answered([&] { read::read_grid(file, {.arrays = {"u"}, .dimension = dimension, .most_components = 3}); });
  answered([&] {
    read::read_grid(file, {.dimension = dimension, .most_components = 3, .missing = read::Missing::nearest});
  });
}

}  // namespace gaussdrift
