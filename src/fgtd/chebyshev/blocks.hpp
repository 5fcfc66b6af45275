// Part of `chebyshev` for few boxes. If all of them stay in the cache, points are sorted a block at a time in the cache,
// and not all at once through main memory. Boxes then carry coefficients of Chebyshev polynomials,
//   c_n = sum_j lambda_j prod_l T_{n_l}(z_jl)   and   s(y) = sum_n c_n prod_l T_{n_l}(z_l),
// which are cheaper at a point than Lagrange's, and are turned into numbers at the nodes once a box:
//   l_m(z) = sum_k t_mk T_k(z),   t_mk = (2 - delta_k0) / P  T_k(z_m),   z_m = cos(pi (m + 1/2) / P).
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fgtd/chebyshev/lattice.hpp"

namespace fgtd::detail {

/// The boxes low .. high of a lattice, numbered with axis[0] slowest.
template <int d>
struct BoxRange {
  BoxIndex<d> low{}, high{};
  std::array<int, d> axis{};

  double count() const {
    double product = 1;
    for (std::size_t l = 0; l < d; ++l) product *= static_cast<double>(high[l] - low[l] + 1);
    return product;
  }
  std::vector<BoxIndex<d>> boxes() const;
};

/// Points sorted at a time: some for every box, so that boxes have runs of them, and few enough for the cache.
constexpr std::size_t block_points(double boxes) { return boxes <= 16 ? 1 << 10 : boxes <= 64 ? 1 << 12 : 1 << 13; }

/// The largest number of boxes of P^d numbers that counts as few for so many points, and whether these are few.
double most_few_boxes(double box_numbers, double points);
bool are_few(double boxes, double box_numbers, double points);

/// Sums of Lagrange polynomials, moments[box][column][P^d], first axis fastest; overwritten, with room for
/// chain_padding numbers behind. weights [columns][points]. Points outside of the range belong to the nearest box.
template <int d>
void block_moments(const BoxLattice<d>& lattice, const BoxRange<d>& range, int nodes, const PointView& points,
                   const double* weights, std::size_t columns, int threads, Buffer<double>& moments);

/// values[q stride + j] at point j, by interpolation from values at nodes [box][outputs][P^d]; 0 for points in boxes
/// beyond least .. most.
template <int d>
void block_values(const BoxLattice<d>& lattice, const BoxRange<d>& range, const BoxIndex<d>& least,
                  const BoxIndex<d>& most, int nodes, const PointView& points, std::size_t outputs,
                  const double* at_nodes, double* values, std::size_t stride, int threads);

/// Bytes that these take beside their arguments and results, at most.
double block_moments_bytes(int d, int nodes, double boxes, double points, double columns, int threads);
double block_values_bytes(int d, int nodes, double boxes, double outputs, int threads);

/// The box of a coordinate as the functions above find it, before it is held to a range.
double box_of(double coordinate, double origin, double side);

}  // namespace fgtd::detail
