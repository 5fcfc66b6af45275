// Pairs closer than a radius, where the kernel is not the sum of Gaussians: their difference is summed pair by pair.
#pragma once

#include <functional>
#include <vector>

#include "rbf/near/cells.hpp"
#include "rbf/near/smooth.hpp"
#include "rbf/rbf.hpp"

namespace rbf::detail {

template <int d>
class NearField {
 public:
  /// @param lattice  around the centres, of side `radius` at least
  NearField(const Function& function, const CellGrid<d>& lattice, double radius, Smooth smooth,
            const Points<d>& centres, int threads);

  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);

  /// Adds to `values`, which has a column for every combination and column of weights, those of the first first.
  void add(const double* targets, std::size_t count, const std::vector<Combination<d>>& combinations,
           Eigen::MatrixXd& values) const;

  /// Bytes that add() takes.
  static double bytes(std::size_t targets) { return 60.0 * static_cast<double>(targets); }

 private:
  Function function_;
  CellGrid<d> lattice_;
  double radius_;
  Smooth smooth_;
  int threads_;
  SortedPoints<d> sorted_;
  std::size_t stride_;
  std::vector<double> position_;  // [d][stride_], sorted
  std::vector<double> weights_;   // [columns][stride_], sorted
  Eigen::Index columns_ = 0;
};

/// The distance within which a centre has about `neighbours` others, from a sample of pairs. 0 if centres coincide.
template <int d>
double distance_of_neighbours(const Points<d>& centres, double neighbours);

}  // namespace rbf::detail
