// What a case names in output.fields, on the points of a box of the evaluation lattice.
#pragma once

#include <string>
#include <vector>

#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/density_grid.hpp"
#include "gaussdrift/lattice_pieces.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

/// Is there anything but the density among them?
bool shows_fields(const OutputSpec& output);

/// Numbers that they take at a point of a file, where vectors have three components.
int field_numbers(const OutputSpec& output, int dimension);

/// The derivatives of the density that the fields need, one after another.
std::vector<DensityDerivatives> derivatives_of(const OutputSpec& output, int dimension);

/// All fields but the density itself, from those derivatives at the points of the box and the velocity at time t there.
/// Where the velocity has no value, what follows from it is not a number.
std::vector<FieldOnGrid> fields_on_grid(const OutputSpec& output, const Lattice& lattice, const LatticeBox& box,
                                        const std::vector<std::vector<double>>& derivatives,
                                        const VelocityField& velocity, double t, int threads);

}  // namespace gaussdrift
