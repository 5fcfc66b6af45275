// Interpolation of a harmonic function in a cluster from its values on the cluster's surface. The interpolant is the
// harmonic polynomial of a degree that fits best by least squares. Nodes are tensor products of Chebyshev-Lobatto
// points.
//   f(t) ~ sum_k h_k(t) sum_i weight[k][i] f(node_i)
// Harmonic functions need d - 1 dimensions of nodes and of polynomials where general ones need d. [Boe22]
#pragma once

#include <cstddef>
#include <vector>

#include "farfield/interpolation/harmonics.hpp"

namespace farfield::detail {

/// Nodes of the interpolation of a degree.
template <int d>
std::size_t nodes_of_degree(int degree);

/// Nodes in the positive octant (2D: quadrant); the others are its reflections. Number s of a reflection: bit l is set
/// if axis l is reversed. Every function is even or odd, so the fit falls apart into 2^d, one for every parity.
template <int d>
class Interpolation {
 public:
  static constexpr std::size_t reflections = std::size_t{1} << d;

  explicit Interpolation(int degree);

  int degree() const { return degree_; }
  std::size_t octant() const { return node_.size() / d; }  // nodes in it
  std::size_t nodes() const { return octant() * reflections; }

  /// Coordinate l of node i of reflection s, in the cube [-1/2, 1/2]^d.
  double node(std::size_t s, std::size_t i, std::size_t l) const {
    return (s >> l & 1U) != 0 ? -node_[i * d + l] : node_[i * d + l];
  }

  /// The functions of parity p, ascending.
  const std::vector<std::size_t>& functions_of(unsigned p) const { return of_parity_[p]; }
  /// For functions of parity p: [octant][functions_of(p)], to be applied to the even or odd part of the function,
  /// the mean of its values at the reflections with signs.
  const std::vector<double>& weights_of(unsigned p) const { return weight_[p]; }

  /// Coefficients from values at all nodes, [reflection][octant].
  void fit(const double* values, double* coefficients) const;
  /// Charges at all nodes that stand for moments, the transposed of fit().
  void substitute(const double* moments, double* charges) const;

 private:
  int degree_;
  std::vector<double> node_;  // [octant][d]
  std::vector<std::size_t> of_parity_[reflections];
  std::vector<double> weight_[reflections];
};

/// +1 or -1: the sign that a function of parity p takes under reflection s.
inline double sign(unsigned p, std::size_t s) {
  return (__builtin_popcount(p & static_cast<unsigned>(s)) & 1) != 0 ? -1.0 : 1.0;
}

}  // namespace farfield::detail
