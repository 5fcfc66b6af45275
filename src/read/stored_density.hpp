// The density of a .vti, or of a .pvti piece by piece.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/density_grid.hpp"
#include "gaussdrift/lattice_pieces.hpp"
#include "read/piece_index.hpp"

namespace gaussdrift::read {

/// An array of it: rho, rho_exact (NaN where it is not known), error, or one of output.fields: of a vector a component, or
/// its length. One piece is held at a time. All throw FileError.
class StoredDensity {
 public:
  StoredDensity(std::filesystem::path file, std::string array, std::optional<std::size_t> component = {});

  const Lattice& lattice() const { return index_.lattice; }
  /// A .vti has one.
  std::size_t pieces() const { return index_.pieces.size(); }
  /// The points that belong to a piece and to no other.
  const LatticeBox& own(std::size_t piece) const { return index_.pieces[piece].own; }
  /// The points that it has, and its values there, first axis fastest; until the next call.
  const LatticeBox& shown(std::size_t piece) const { return index_.pieces[piece].shown; }
  const std::vector<double>& values(std::size_t piece);
  /// Of the first piece; reads it.
  std::optional<double> time();
  /// Of a value of the array; likewise.
  std::size_t components();

 private:
  void check_fits(std::size_t piece, const DensityGrid& read) const;

  std::filesystem::path file_;
  std::string array_;
  std::optional<std::size_t> component_;
  PieceIndex index_;
  std::optional<std::size_t> held_;
  std::vector<double> values_;
  std::optional<double> time_;
  std::size_t components_ = 1;
};

/// The density of a .vti, or every k-th point of a .pvti (thinning()). Throws FileError.
DensityGrid read_density(const std::filesystem::path& file, const std::string& array,
                         std::optional<std::size_t> component = {});

/// The components of a vector that has as many as the grid has dimensions, at the same points. Throws FileError.
FieldOnGrid read_vector(const std::filesystem::path& file, const std::string& array);

}  // namespace gaussdrift::read
