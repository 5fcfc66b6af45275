// Polynomials on cubes, and the kernel between two cubes as a sum of their products.
//
// A cluster's polynomials are products of psi_a(x) = sqrt(2a + 1) P_a(2x) on [-1/2, 1/2], P_a being those of Legendre. They
// are orthonormal in the mean over the cube. So the root of the sum of squares of a matrix of coefficients is the root mean
// square of what it stands for over all pairs of points of two cubes.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "farfield/general/kernel.hpp"

namespace farfield::detail {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// psi_0 .. psi_degree at x.
void legendre_values(double x, int degree, double* values);

/// entry (a, b): of psi_a of a cube, restricted to its lower (half = 0) or upper half, the coefficient of the half's psi_b.
RowMatrix legendre_restriction(int degree, int half);

/// Which products of polynomials a cluster has. `total`: those of total degree up to `order`; else all of degree up to
/// `order` in each axis. Products of one parity follow each other where `by_parity`.
struct Products {
  using Degrees = std::array<std::uint8_t, 3>;
  Products(int dimension, int order, bool total, bool by_parity);

  int dimension, order;
  bool total;
  std::vector<Degrees> degrees;
  std::vector<std::size_t> part_begin;  // of every parity, and the end

  std::size_t size() const { return degrees.size(); }
  /// Bit l is set where the polynomial in axis l is odd.
  static unsigned parity(const Degrees& degrees);
  /// The order from which on a product is among those of `total`.
  static int order_of(const Degrees& degrees, bool total);
};

/// psi of all products at a point of the cube [-1/2, 1/2]^d.
void product_values(const Products& products, const double* point, double* values);

/// Restriction to a child: entry (a, b) of product a of the parent and product b of the child.
RowMatrix product_restriction(const Products& parent, const Products& child, unsigned octant);

/// The kernel k(h (c + z)) for z in [-1, 1]^d, interpolated at tensor products of Chebyshev points.
class DifferenceInterpolant {
 public:
  /// order: of the polynomial in every axis. Throws InvalidArgument where a value is not finite.
  DifferenceInterpolant(const KernelData& kernel, int dimension, double side, const std::array<int, 3>& offset,
                        int order);

  /// The root mean square of the error at random places.
  double error() const { return error_; }
  /// The largest value at the nodes.
  double size() const { return size_; }

  /// As a polynomial in x and y, z = x - y: entry (a, b) is the coefficient of product a in x and product b in y. This is
  /// symmetric interpolation: what is beyond the products is cut off.
  RowMatrix coefficients(const Products& products) const;

 private:
  int dimension_, order_;
  std::vector<double> coefficients_;  // [j1][j2][j3]
  double error_ = 0, size_ = 0;
};

}  // namespace farfield::detail
