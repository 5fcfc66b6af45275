// The two methods that replace clusters of points [Boe22]. `tree` replaces clusters of sources by substitute charges,
// which act on the targets. `symmetric` couples clusters of sources with clusters of targets.
#pragma once

#include <functional>
#include <memory>

#include "farfield/interpolation/operators.hpp"
#include "farfield/near/near_field.hpp"
#include "farfield/tree/partition.hpp"
#include "farfield/tree/transformation.hpp"

namespace farfield::detail {

struct MethodEntry;  // farfield/catalogue.hpp
MethodEntry tree_method();
MethodEntry symmetric_method();

template <int d>
class Clustered : public Summation {
 public:
  struct Parts {
    Tree<d> tree;
    Partition partition;
    std::shared_ptr<const Operators<d>> operators;  // null if there is one cluster, which all pairs are in
    Precisions precisions;
    int threads;
    Work work;  // of one evaluation
    /// On several ranks: sets the charges of points, and moments of clusters, that other ranks have. Null: there are none.
    std::function<void(Buffer<double>& charges, PerCluster& moments, std::size_t functions)> exchange{};
    double exchange_bytes = 0;
  };
  Clustered(const Problem& problem, Parts parts);

  void evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const final;
  double evaluation_bytes() const override;

 protected:
  /// Charges and sums in the order of the tree.
  virtual void add_all(const Buffer<double>& charges, const PerCluster& moments, Sums& sums,
                       Seconds& seconds) const = 0;

  /// Sums, at all leaves of targets, runs pair by pair and smaller clusters of sources by their substitute charges.
  void add_at_leaves(const Buffer<double>& charges, const PerCluster& moments, Sums& sums) const;
  double bytes_per_cluster() const { return operators_ ? 8.0 * static_cast<double>(operators_->functions()) : 0; }

  const Problem& problem_;
  const Tree<d> tree_;
  const Partition partition_;
  const std::shared_ptr<const Operators<d>> operators_;
  const NearField<d> near_;
  const int threads_;
  const Work work_;
  const std::function<void(Buffer<double>&, PerCluster&, std::size_t)> exchange_;
  const double exchange_bytes_;
};

template <int d>
class TreeMethod : public Clustered<d> {
 public:
  using Clustered<d>::Clustered;

 protected:
  void add_all(const Buffer<double>& charges, const PerCluster& moments, Sums& sums, Seconds& seconds) const override;
};

template <int d>
class SymmetricMethod : public Clustered<d> {
 public:
  using Clustered<d>::Clustered;
  double evaluation_bytes() const override;

 protected:
  void add_all(const Buffer<double>& charges, const PerCluster& moments, Sums& sums, Seconds& seconds) const override;

 private:
  void couple(const CouplingChunk& chunk, const PerCluster& moments, PerCluster& coefficients) const;
  void add_from_points(const Buffer<double>& charges, PerCluster& coefficients) const;
};

}  // namespace farfield::detail
