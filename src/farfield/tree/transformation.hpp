// Forward and backward transformation [Boe22]: moments of every cluster from charges, bottom up, and sums at the
// targets from coefficients of every cluster, top down. Both take one matrix for an octant, whatever the level.
#pragma once

#include "farfield/interpolation/operators.hpp"
#include "farfield/tree/tree.hpp"

namespace farfield::detail {

/// Numbers of every cluster: [cluster][functions], by parity as Operators keeps them.
using PerCluster = Buffer<double>;

/// moments[cluster][k] = sum_j q_j h_k(y_j) over the cluster's sources; 0 for clusters without sources. Those of own
/// clusters alone.
template <int d>
PerCluster forward(const Tree<d>& tree, const Operators<d>& operators, const Buffer<double>& charges, int threads);

/// Moments of shared clusters from those of their children, in the same order as if they were own ones.
template <int d>
void forward_shared(const Tree<d>& tree, const Operators<d>& operators, int threads, PerCluster& moments);

/// Adds the potential sum_k coefficients[cluster][k] h_k and its gradient times `sign` at the targets of all clusters;
/// coefficients are added up downwards on the way.
template <int d>
void backward(const Tree<d>& tree, const Operators<d>& operators, PerCluster& coefficients, double sign, bool potential,
              int threads, Sums& sums);

}  // namespace farfield::detail
