// Sums every pair.
#pragma once

#include <cstddef>
#include <functional>
#include <vector>

#include "rbf/rbf.hpp"

namespace rbf::detail {

/// Seconds of one pair on one thread, of values.
double pair_seconds(Kernel kernel);

template <int d>
class DirectSum {
 public:
  DirectSum(const Function& function, const Points<d>& centres, int threads);

  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) { weights_ = weights; }

  /// point(i, coordinates) writes target i.
  Eigen::MatrixXd evaluate(std::size_t count, const std::vector<Combination<d>>& combinations,
                           const std::function<void(std::size_t, double*)>& point) const;

 private:
  Function function_;
  std::vector<double> position_;  // [d][count]
  std::size_t sources_;
  int threads_;
  Eigen::MatrixXd weights_;
};

}  // namespace rbf::detail
