// .pvd: the list, and the grids that it names.
#include "fuzz_target.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift {

FUZZ_TARGET(series) {
  static const bool written = [] {
    for (const char* name : {"a.vti", "b.vti"})
      fuzz::folder().write(
          name,
          "<VTKFile type=\"ImageData\"><ImageData WholeExtent=\"0 1 0 1 0 0\"><Piece Extent=\"0 1 0 1 0 0\"><PointData>"
          "<DataArray type=\"Float64\" Name=\"rho\" format=\"ascii\">1 2 3 "
          "4</DataArray></PointData></Piece></ImageData>"
          "</VTKFile>");
    return true;
  }();
  if (!written) return;
  try {
    read::read_grid(fuzz::folder().write("series.pvd", text), {});
  } catch (const read::GridFileError&) {
  }
}

}  // namespace gaussdrift
