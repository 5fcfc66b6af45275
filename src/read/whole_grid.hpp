// Grids of other kinds of ParaView's files, read whole: legacy .vtk, and .vti in pieces (.pvti).
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <vector>

#include "read/stored_grid.hpp"

namespace gaussdrift::read {

struct WholeGrid {
  std::array<std::size_t, 3> points{1, 1, 1};
  std::array<std::vector<double>, 3> axis;
  std::array<double, 3> rounding{};
  std::vector<ArrayInfo> arrays;
  std::vector<ArrayValues> values;                  // of the arrays
  std::array<std::vector<std::uint8_t>, 2> hidden;  // points, cells
  double time = std::numeric_limits<double>::quiet_NaN();
};

/// STRUCTURED_POINTS or RECTILINEAR_GRID, as text or binary. Throws GridFileError.
WholeGrid read_legacy_vtk(const std::filesystem::path& file);
/// The pieces of a .pvti put together. Throws GridFileError.
WholeGrid read_pvti(const std::filesystem::path& file);

}  // namespace gaussdrift::read
