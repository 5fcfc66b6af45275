// What is compared with the exact density where the density comes in pieces.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/exact_sum.hpp"
#include "gaussdrift/frame.hpp"
#include "gaussdrift/lattice_pieces.hpp"
#include "reference/reference.hpp"
#include "sim/comparison.hpp"

namespace gaussdrift {

/// Norms over all points from the pieces of all ranks. Sums are exact, so that they do not depend on who has which.
class PieceComparison {
 public:
  /// `size`: a value of about the size of the density, so that squares neither overflow nor vanish.
  PieceComparison(const Lattice& lattice, const LatticePieces& pieces, double size);

  void begin();
  /// The exact density of a piece, and its part of the norms: that of the points that belong to it.
  void compare(const Reference& reference, double time, const DensityPiece& piece, std::vector<double>& exact);
  /// The norms of all ranks, which call it together.
  void tell(base::Communicator& ranks, FrameNumbers& numbers);

 private:
  enum Sum : std::size_t { error_1, error_2, norm_1, norm_2, sums };

  const Lattice& lattice_;
  const LatticePieces& pieces_;
  double scale_ = 1;  // a power of two
  std::vector<base::ExactSum> sums_;
  double largest_error_ = 0, largest_ = 0;
  std::int64_t untraced_ = 0;
};

/// Numbers of points of a thinned lattice as those of the whole one.
std::vector<std::size_t> points_of_thinned(const std::vector<std::size_t>& points, const Lattice& thin,
                                           std::size_t every, const Lattice& whole);

/// What cannot be had where a density comes in pieces, for the user.
std::string words_for_pieces(const LatticePieces& pieces, const Lattice& lattice, const Comparison& compared,
                             bool compares_pieces);

}  // namespace gaussdrift
