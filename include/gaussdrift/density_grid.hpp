/// @file
/// A density on the points of a lattice: what a run sums, files hold and pictures show.
#pragma once

#include <string>
#include <vector>

#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

/// A quantity on the points of a lattice, `output.fields` of a case.
struct FieldOnGrid {
  std::string name;            ///< "gradient"
  int components = 1;          ///< of a value
  std::vector<double> values;  ///< components first, then the first axis fastest; NaN where it has no value
};

/// rho_eps^h on the evaluation lattice.
struct DensityGrid {
  Lattice lattice;                    ///< its points
  std::vector<double> rho;            ///< at each of them, first axis fastest; mass / length^dimension
  std::vector<FieldOnGrid> fields{};  ///< what the case names beside it, at the same points
};

}  // namespace gaussdrift
