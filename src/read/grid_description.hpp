// What a .vti, .vtr or .vts says of itself: every attribute is read whole, all pieces have the same arrays, and they do not
// overlap.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "read/stored_grid.hpp"
#include "read/xml_tree.hpp"

namespace gaussdrift::read {

/// First and last index of points on each axis, both included.
using Extent = std::array<int, 6>;

/// How many points (or cells) a piece has along each axis. An axis with one layer of points in the whole grid has one
/// layer of cells.
std::array<std::size_t, 3> lengths(const Extent& piece, const Extent& whole, bool cells);

/// Calls work(first, count) with every row along x of a piece: its points (cells) in the order of the whole grid.
template <class Work>
void for_rows(const Extent& piece, const Extent& whole, bool cells, const Work& work) {
  const auto some = lengths(piece, whole, cells), all = lengths(whole, whole, cells);
  const auto start = [&](std::size_t k) { return static_cast<std::size_t>(piece[2 * k] - whole[2 * k]); };
  for (std::size_t c = 0; c < some[2]; ++c)
    for (std::size_t b = 0; b < some[1]; ++b)
      work(((start(2) + c) * all[1] + start(1) + b) * all[0] + start(0), some[0]);
}

struct Piece {
  Extent extent{};
  std::vector<const Element*> arrays;       // as GridDescription::arrays
  std::vector<const Element*> coordinates;  // of a rectilinear grid, x, y, z
};

struct GridDescription {
  Extent extent{};
  std::vector<Piece> pieces;
  std::vector<ArrayInfo> arrays;                     // of all pieces, masks too
  std::vector<std::vector<double>> fill_values;      // of each array, by its attributes
  std::vector<const Element*> fields;                // arrays of no points and cells
  std::array<double, 3> origin{}, spacing{1, 1, 1};  // of image data
  std::array<double, 3> origin_rounding{}, spacing_rounding{};

  /// Do the pieces cover the points (the cells) of the extent? Takes a bit for each.
  bool covered(bool cells) const;
  /// Do two pieces have the same cell? Takes a bit for each.
  bool overlaps() const;
};

/// Where coordinates are: in attributes, in an array an axis, or in an array of points.
enum class GridKind { image, rectilinear, curved };

/// Points at `grid`. The places of the points of a curvilinear grid are the last one of its arrays, with 3 components.
/// Throws GridFileError.
GridDescription describe_grid(const FileBytes& file, const Element& grid, GridKind kind);

}  // namespace gaussdrift::read
