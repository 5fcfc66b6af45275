// A .pvti: image data in pieces, each in a .vti of its own. The index is not believed: its pieces must fill the grid
// without overlap, and lie in its folder.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "gaussdrift/lattice_pieces.hpp"

namespace gaussdrift::read {

struct IndexedPiece {
  std::filesystem::path file;
  LatticeBox shown;  // the points that it has
  LatticeBox own;    // those that no other piece counts as its own: without the last layer, but at the end of the grid
  std::size_t line = 0;  // of the index
};

struct PieceIndex {
  Lattice lattice;  // of all pieces; spacings are the same on all axes
  std::vector<IndexedPiece> pieces;
};

/// Throws GridFileError.
PieceIndex read_piece_index(const std::filesystem::path& file);

}  // namespace gaussdrift::read
