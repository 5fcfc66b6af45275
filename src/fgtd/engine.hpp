// What a Plan holds: the sources in the order its method wants, the choice, and for `hermite` the moments.
#pragma once

#include <vector>

#include "fgtd/direct.hpp"
#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

template <int d>
class Engine {
 public:
  Engine(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights, double sigma,
         const Options& options);

  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets, const std::vector<Combination<d>>& combinations) const;
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);
  const Choice& choice() const { return choice_; }

 private:
  double plan_bytes(std::size_t columns) const;

  double sigma_;
  Options options_;
  Choice choice_;
  Sources<d> sources_;
};

}  // namespace fgtd::detail
