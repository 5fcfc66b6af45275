// What a Plan holds: the sources in the order its method wants, the choice, and for `hermite` the moments.
#pragma once

#include <optional>
#include <vector>

#include "fgtd/direct.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/hermite.hpp"

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
  /// Bytes of the plan with so many columns of weights.
  double plan_bytes(std::size_t columns) const;

  double sigma_;
  Options options_;
  Choice choice_;
  Sources<d> sources_;
  std::vector<std::size_t> order_;  // sources_[j] is the caller's source order_[j]; empty: as given
  std::optional<HermiteSum<d>> hermite_;
};

}  // namespace fgtd::detail
