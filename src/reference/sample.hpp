// Some points of a lattice that stand for all of them.
#pragma once

#include <cstddef>
#include <vector>

#include "gaussdrift/lattice.hpp"

namespace gaussdrift {

struct GridSample {
  std::vector<std::size_t> points;
  std::vector<double> weight;  // how many points of the lattice each stands for, on a sphere as parts of the largest
                               // cell; 0: for the largest error alone
};

/// Of the area, or volume, that belongs to a point: what part it is of the largest there is. Less than 1 on a sphere alone.
double part_of_largest_cell(const Lattice& lattice, std::size_t point);

/// About `count` points. Half of them are points where |rho| is at least a millionth of its largest value, half are
/// others. Each half is spread evenly over its points. The neighbourhood of the largest value is added; it counts for
/// the largest error alone. All points if there are not more than `count`.
GridSample sample_of_grid(const Lattice& lattice, const std::vector<double>& rho, std::size_t count);

}  // namespace gaussdrift
