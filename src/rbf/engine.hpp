// The implementation of Plan: checks the arguments, chooses the method, and passes the work on.
#pragma once

#include <fgtd/mixture.hpp>
#include <functional>
#include <optional>
#include <vector>

#include "rbf/direct.hpp"
#include "rbf/expansion/expansion.hpp"
#include "rbf/moments.hpp"
#include "rbf/near/near.hpp"
#include "rbf/rbf.hpp"

namespace rbf::detail {

template <int d>
class Engine {
 public:
  Engine(const Function& function, const Eigen::Ref<const Points<d>>& centres,
         const Eigen::Ref<const Eigen::MatrixXd>& weights, const Options& options);

  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets,
                           const std::vector<Combination<d>>& combinations) const;
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);
  const Choice& choice() const { return choice_; }

 private:
  /// Predicted seconds of `direct`.
  double direct_seconds() const;
  /// The kernel as Gaussians, with a near field where that is faster; makes near_ and sets choice_.near.
  Expansion expand_kernel();
  /// Fills choice_, moments_, near_ and gaussians_.
  void plan_gaussians(const Eigen::Ref<const Eigen::MatrixXd>& weights);
  /// Throws if a derivative is not prepared for.
  void check_combinations(const std::vector<Combination<d>>& combinations) const;
  /// The sum at `count` targets, the coordinates of which point(i, coordinates) writes; `of_gaussians()` has
  /// gaussians_ evaluated at them. All relative to origin_. `packed` is the targets as columns, if they are that already.
  Eigen::MatrixXd evaluate(std::size_t count, const std::vector<Combination<d>>& combinations,
                           const std::function<void(std::size_t, double*)>& point,
                           const std::function<Eigen::MatrixXd()>& of_gaussians, const double* packed) const;

  Function function_;
  Options options_;
  Choice choice_;
  Eigen::Matrix<double, d, 1> origin_, low_, high_;  // the middle of the box around the centres, and its corners
  Points<d> centres_;                                // relative to origin_
  Eigen::Index columns_ = 0;
  std::optional<DirectSum<d>> direct_;
  Moments<d> moments_;
  std::optional<NearField<d>> near_;
  std::optional<fgtd::Mixture<d>> gaussians_;  // choice_.terms
};

}  // namespace rbf::detail
