#include "read/piece_index.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>

#include "base/lies_in.hpp"
#include "base/printable.hpp"
#include "read/grid_description.hpp"
#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

namespace {

constexpr std::size_t most_pieces = 131072;

/// Where a piece lies. It may not lead out of the folder of the index, not by a link either.
std::filesystem::path file_of(const FileBytes& bytes, const Element& piece, const std::filesystem::path& index) {
  namespace fs = std::filesystem;
  const std::string* source = piece.attribute("Source");
  if (!source || source->empty())
    throw GridFileError(fmt::format("{}: this <Piece> has no Source", line_of(bytes, piece)));
  const fs::path folder = index.has_parent_path() ? index.parent_path() : fs::path(".");
  const fs::path file = folder / *source;
  if (fs::path(*source).is_absolute() || !base::lies_in(file, folder))
    throw GridFileError(fmt::format("{}: the piece {} is not in the folder of {}", line_of(bytes, piece),
                                    base::in_quotes(*source, 60), bytes.name()));
  if (file.extension() != ".vti")
    throw GridFileError(
        fmt::format("{}: the piece {} is not a .vti", line_of(bytes, piece), base::in_quotes(*source, 60)));
  return file;
}

LatticeBox box_of(const Extent& extent, const Extent& whole) {
  LatticeBox box;
  for (std::size_t k = 0; k < 3; ++k) {
    box.first[k] = static_cast<std::size_t>(extent[2 * k] - whole[2 * k]);
    box.points[k] = static_cast<std::size_t>(extent[2 * k + 1] - extent[2 * k]) + 1;
  }
  return box;
}

/// Points in the middle of which cells are counted: all but the last layers of the grid.
double cells_of(const LatticeBox& box, const Lattice& lattice) {
  double cells = 1;
  for (std::size_t k = 0; k < 3; ++k)
    if (lattice.points[k] > 1) cells *= static_cast<double>(box.points[k] - 1);
  return cells;
}

bool overlap(const LatticeBox& a, const LatticeBox& b, const Lattice& lattice) {
  for (std::size_t k = 0; k < 3; ++k)
    if (lattice.points[k] > 1 && (a.end(k) - 1 <= b.first[k] || b.end(k) - 1 <= a.first[k])) return false;
  return true;
}

void check_pieces(const FileBytes& bytes, const PieceIndex& index) {
  // Pieces that begin before the end of another one on the axis where most begin at different places.
  std::size_t axis = 0, most = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    std::set<std::size_t> begins;
    for (const IndexedPiece& piece : index.pieces) begins.insert(piece.shown.first[k]);
    if (begins.size() > most) most = begins.size(), axis = k;
  }
  std::vector<std::size_t> order(index.pieces.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const std::size_t x = index.pieces[a].shown.first[axis], y = index.pieces[b].shown.first[axis];
    return x != y ? x < y : a < b;
  });
  double cells = 0;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const IndexedPiece& piece = index.pieces[order[i]];
    cells += cells_of(piece.shown, index.lattice);
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const IndexedPiece& other = index.pieces[order[j]];
      if (other.shown.first[axis] >= piece.shown.end(axis)) break;
      if (overlap(piece.shown, other.shown, index.lattice))
        throw GridFileError(
            fmt::format("{}: the pieces of lines {} and {} overlap by more than a layer of points", bytes.name(),
                        std::min(piece.line, other.line), std::max(piece.line, other.line)),
            "write the file again with pieces that have no cells in common");
    }
  }
  const LatticeBox whole{{}, index.lattice.points};
  if (cells != cells_of(whole, index.lattice))
    throw GridFileError(fmt::format("the pieces of {} leave cells of its extent without values", bytes.name()),
                        "write the file again with all of its pieces");
}

Lattice lattice_of(const FileBytes& bytes, const Element& grid, const GridDescription& about) {
  Lattice lattice;
  lattice.dimension = about.extent[4] == about.extent[5] ? 2 : 3;
  double points = 1;
  for (std::size_t k = 0; k < 3; ++k) {
    lattice.points[k] = static_cast<std::size_t>(about.extent[2 * k + 1] - about.extent[2 * k]) + 1;
    lattice.origin[k] = about.origin[k] + about.spacing[k] * about.extent[2 * k];
    points *= static_cast<double>(lattice.points[k]);
  }
  constexpr double most_points = 1099511627776.0;  // 2^40, as cases have it
  if (points > most_points)
    throw GridFileError(
        fmt::format("{} has {:.3g} points; at most {:.3g} are possible", bytes.name(), points, most_points));
  lattice.spacing = about.spacing[0];
  for (int k = 0; k < lattice.dimension; ++k) {
    const double spacing = about.spacing[static_cast<std::size_t>(k)];
    if (!(spacing > 0) || std::abs(spacing - lattice.spacing) > 1e-6 * lattice.spacing)
      throw GridFileError(
          fmt::format("{}: Spacing is not the same on all axes, as that of densities is", line_of(bytes, grid)));
  }
  return lattice;
}

}  // namespace

PieceIndex read_piece_index(const std::filesystem::path& file) {
  check_readable(file);
  FileBytes bytes(file);
  const XmlFile xml = read_xml(bytes);
  const std::string* type = xml.root.attribute("type");
  const Element* grid = xml.root.child("PImageData");
  if (xml.root.name != "VTKFile" || !type || *type != "PImageData" || !grid)
    throw GridFileError(
        fmt::format("{} is not a file of the kind that its name says: .pvti has <VTKFile "
                    "type=\"PImageData\"> and a <PImageData> inside",
                    bytes.name()));
  const GridDescription about = describe_grid(bytes, *grid, GridKind::image);
  PieceIndex index;
  index.lattice = lattice_of(bytes, *grid, about);
  for (const Element& child : grid->children) {
    if (child.name != "Piece") continue;
    if (index.pieces.size() == most_pieces)
      throw GridFileError(fmt::format("{} has more than {} pieces", bytes.name(), most_pieces));
    IndexedPiece piece{
        file_of(bytes, child, file), box_of(about.pieces[index.pieces.size()].extent, about.extent), {}, child.line};
    piece.own = piece.shown;
    for (std::size_t k = 0; k < 3; ++k) {
      if (index.lattice.points[k] > 1 && piece.shown.points[k] == 1)
        throw GridFileError(
            fmt::format("{}: this piece has a single layer of points along {}", line_of(bytes, child), "xyz"[k]));
      if (piece.own.end(k) < index.lattice.points[k]) --piece.own.points[k];
    }
    index.pieces.push_back(std::move(piece));
  }
  if (index.pieces.empty()) throw GridFileError(fmt::format("{} names no pieces", bytes.name()));
  check_pieces(bytes, index);
  return index;
}

}  // namespace gaussdrift::read
