#include "sim/grid_pieces.hpp"

#include "sim/scene.hpp"

namespace gaussdrift {

LatticePieces pieces_of_grid(const Case& spec) {
  if (!(spec.domain.max[0] > spec.domain.min[0])) return {};
  return LatticePieces(evaluation_lattice(spec), spec.evaluate.piece_points);
}

Lattice shown_grid(const Case& spec) {
  const Lattice lattice = evaluation_lattice(spec);
  return pieces_of_grid(spec).count() == 1 ? lattice : thinned(lattice, thinning(lattice));
}

}  // namespace gaussdrift
