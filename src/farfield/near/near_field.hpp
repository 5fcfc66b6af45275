// The sums for the targets of one leaf: pair by pair, or with substitute charges in place of points.
#pragma once

#include "farfield/interpolation/interpolation.hpp"
#include "farfield/tree/tree.hpp"

namespace farfield::detail {

/// The precision of pairs of points, and of substitute charges with points.
struct Precisions {
  Precision points, substitutes;
  double point_beyond;  // of PairsJob
};

/// The precision that keeps a tolerance. Substitution takes at most a quarter of the tolerance.
Precisions precisions_for(double tolerance, Interaction interaction);
/// Largest error of a sum relative to the sum of its terms' sizes.
double error_of(Precision precision);
/// The rounding that substitute charges add to the error of interpolation. Together they may be ten times larger than
/// the charges that they stand for.
double substitution_error(Precision precision);

/// Everything in the order of the tree.
template <int d>
class NearField {
 public:
  NearField(const Problem& problem, const Tree<d>& tree, Precisions precisions)
      : problem_(problem), tree_(tree), precisions_(precisions) {}

  /// Sources of the runs at the targets of a leaf.
  void add(const Cluster& leaf, const Range* runs, std::size_t count, const Buffer<double>& charges, Sums& sums) const;

  /// Room for substitute charges that are used together.
  struct Substitutes {
    Coordinates position;
    Buffer<double> charge;
    std::size_t count = 0;
    double reach = 0;
    std::vector<double> moments;  // of the cluster to be added
  };
  /// Adds the nodes of a cluster of sources, with the charges that stand for substitutes.moments. When too much has
  /// gathered, it acts on the leaf first.
  void add(const Cluster& leaf, const Interpolation<d>& interpolation, const Cluster& sources, Substitutes& substitutes,
           Sums& sums) const;
  /// Lets the gathered charges act on the leaf.
  void act(const Cluster& leaf, Substitutes& substitutes, Sums& sums) const;

  /// The potential of the sources in `range` at the nodes of a cluster, overwritten. In 2D it is without log_shift,
  /// which is added to the fitted constant, because large numbers at nodes cost digits.
  void at_nodes(const Cluster& cluster, const Interpolation<d>& interpolation, Range range,
                const Buffer<double>& charges, double* values) const;

 private:
  PairsJob job_for(const Cluster& leaf, Sums& sums) const;
  static void set_reach(double reach, PairsJob& job);
  void nodes_of(const Cluster& cluster, const Interpolation<d>& interpolation, Coordinates& to,
                std::size_t first) const;

  const Problem& problem_;
  const Tree<d>& tree_;
  Precisions precisions_;
};

}  // namespace farfield::detail
