#include <fmt/format.h>

#include <algorithm>

#include "read/grid_file_error.hpp"
#include "read/piece_index.hpp"
#include "read/whole_grid.hpp"

namespace gaussdrift::read {

namespace {

bool same(const std::vector<ArrayInfo>& a, const std::vector<ArrayInfo>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const ArrayInfo& one, const ArrayInfo& other) {
    return one.name == other.name && one.components == other.components && one.on_cells == other.on_cells;
  });
}

/// Calls copy(from, to) for each point, or cell, of a piece: its number there, and in the whole grid.
template <class Copy>
void each_entry(const LatticeBox& box, const std::array<std::size_t, 3>& points, bool cells, const Copy& copy) {
  std::array<std::size_t, 3> some{}, all{};
  for (std::size_t k = 0; k < 3; ++k) {
    some[k] = cells ? std::max<std::size_t>(1, box.points[k] - 1) : box.points[k];
    all[k] = cells ? std::max<std::size_t>(1, points[k] - 1) : points[k];
  }
  std::size_t from = 0;
  for (std::size_t c = 0; c < some[2]; ++c)
    for (std::size_t b = 0; b < some[1]; ++b)
      for (std::size_t a = 0; a < some[0]; ++a, ++from)
        copy(from, ((box.first[2] + c) * all[1] + box.first[1] + b) * all[0] + box.first[0] + a);
}

}  // namespace

WholeGrid read_pvti(const std::filesystem::path& file) {
  const PieceIndex index = read_piece_index(file);
  const Lattice& lattice = index.lattice;
  WholeGrid grid;
  double points = 1, cells = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    grid.points[k] = lattice.points[k];
    points *= static_cast<double>(lattice.points[k]);
    cells *= static_cast<double>(std::max<std::size_t>(1, lattice.points[k] - 1));
    for (std::size_t i = 0; i < grid.points[k]; ++i) grid.axis[k].push_back(lattice.coordinate(static_cast<int>(k), i));
  }
  for (const IndexedPiece& piece : index.pieces) {
    StoredGrid part(piece.file);
    const std::string place = piece.file.filename().string();
    for (std::size_t k = 0; k < 3; ++k)
      if (part.points()[k] != piece.shown.points[k])
        throw GridFileError(fmt::format("{} has {} points along {}, and line {} of {} says {}", place, part.points()[k],
                                        "xyz"[k], piece.line, file.filename().string(), piece.shown.points[k]));
    if (grid.arrays.empty()) {
      grid.arrays = part.arrays();
      double numbers = 0;
      for (const ArrayInfo& array : grid.arrays)
        numbers += (array.on_cells ? cells : points) * static_cast<double>(array.components);
      if (numbers > most_numbers)
        throw GridFileError(fmt::format("{} has {:.3g} numbers; at most {:.3g} are read", file.filename().string(),
                                        numbers, most_numbers),
                            "leave points or arrays out");
      for (const ArrayInfo& array : grid.arrays)
        grid.values.push_back(
            {std::vector<double>(static_cast<std::size_t>(array.on_cells ? cells : points) * array.components), {}});
    }
    if (!same(grid.arrays, part.arrays()))
      throw GridFileError(fmt::format("{} has other arrays than the pieces before it", place),
                          "write the file again with the same arrays in all pieces");
    part.load(grid.arrays);
    for (std::size_t a = 0; a < grid.arrays.size(); ++a) {
      const std::size_t components = grid.arrays[a].components;
      const ArrayValues& some = part.values()[a];
      each_entry(piece.shown, grid.points, grid.arrays[a].on_cells, [&](std::size_t from, std::size_t to) {
        std::copy_n(some.numbers.data() + from * components, components,
                    grid.values[a].numbers.data() + to * components);
      });
      grid.values[a].fill_values.insert(grid.values[a].fill_values.end(), some.fill_values.begin(),
                                        some.fill_values.end());
    }
    for (const bool of_cells : {false, true}) {
      const std::vector<std::uint8_t>& mask = part.hidden(of_cells);
      if (mask.empty()) continue;
      grid.hidden[of_cells].resize(static_cast<std::size_t>(of_cells ? cells : points));
      each_entry(piece.shown, grid.points, of_cells,
                 [&](std::size_t from, std::size_t to) { grid.hidden[of_cells][to] |= mask[from]; });
    }
    for (std::size_t k = 0; k < 3; ++k) {
      grid.rounding[k] = std::max(grid.rounding[k], part.rounding(k));
      const double first = part.axis(k).front(), last = part.axis(k).back();
      const double slack = 1e-6 * lattice.spacing;
      if (std::abs(first - grid.axis[k][piece.shown.first[k]]) > slack ||
          std::abs(last - grid.axis[k][piece.shown.end(k) - 1]) > slack)
        throw GridFileError(fmt::format("{} lies elsewhere than line {} of {} says: it goes from {} to {} along {}",
                                        place, piece.line, file.filename().string(), first, last, "xyz"[k]));
    }
    grid.time = part.time();
  }
  return grid;
}

}  // namespace gaussdrift::read
