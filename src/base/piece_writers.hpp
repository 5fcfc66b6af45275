// Which rank has which of several pieces: each a run of neighbours, of nearly equal numbers.
#pragma once

#include <cstddef>

namespace gaussdrift::base {

/// The rank that has a piece.
inline int writer_of_piece(std::size_t piece, std::size_t pieces, int ranks) {
  return static_cast<int>(piece * static_cast<std::size_t>(ranks) / pieces);
}

/// The first piece of a rank, if it has any; the number of pieces for the rank behind the last.
inline std::size_t first_piece_of(int rank, std::size_t pieces, int ranks) {
  const auto size = static_cast<std::size_t>(ranks);
  return (static_cast<std::size_t>(rank) * pieces + size - 1) / size;
}

/// The most pieces of a rank: so many rounds hand all of them out, one a rank at a time.
inline std::size_t rounds_of_pieces(std::size_t pieces, int ranks) {
  const auto size = static_cast<std::size_t>(ranks);
  return (pieces + size - 1) / size;
}

/// The piece of a rank in a round; the number of pieces if it has none.
inline std::size_t piece_of_round(std::size_t round, int rank, std::size_t pieces, int ranks) {
  const std::size_t piece = first_piece_of(rank, pieces, ranks) + round;
  return piece < first_piece_of(rank + 1, pieces, ranks) ? piece : pieces;
}

}  // namespace gaussdrift::base
