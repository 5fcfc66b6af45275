// The implementation of Plan: checks the arguments, has a method chosen, and passes the work on.
#pragma once

#include <memory>

#include "fgtd/fgtd.hpp"
#include "fgtd/summation.hpp"

namespace fgtd::detail {

template <int d>
class Engine {
 public:
  Engine(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights, double sigma,
         const Options& options);

  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets,
                           const std::vector<Combination<d>>& combinations) const;
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);
  const Choice& choice() const { return choice_; }

 private:
  /// Weights that have been checked.
  void take_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);

  double sigma_;
  Options options_;
  Choice choice_;
  std::size_t sources_ = 0;
  std::size_t columns_ = 0;
  std::unique_ptr<Summation<d>> summation_;
};

}  // namespace fgtd::detail
