// The public class: forwards to its engine.
#include "fgtd/engine.hpp"
#include "fgtd/fgtd.hpp"

namespace fgtd {

template <int d>
Plan<d>::Plan(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights,
              double sigma, const Options& options)
    : engine_(std::make_unique<detail::Engine<d>>(sources, weights, sigma, options)) {}

template <int d>
Plan<d>::~Plan() = default;
template <int d>
Plan<d>::Plan(Plan&&) noexcept = default;
template <int d>
Plan<d>& Plan<d>::operator=(Plan&&) noexcept = default;

template <int d>
void Plan<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  engine_->set_weights(weights);
}

template <int d>
const Choice& Plan<d>::choice() const {
  return engine_->choice();
}

// At points, then on grids.

template <int d>
Eigen::MatrixXd Plan<d>::evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha) const {
  return evaluate_combination(targets, {{alpha, 1.0}});
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate_combination(const Eigen::Ref<const Points<d>>& targets,
                                              const Combination<d>& combination) const {
  return evaluate_combinations(targets, {combination});
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                               const std::vector<Combination<d>>& combinations) const {
  return engine_->evaluate(targets, combinations);
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate(const TensorGrid& grid, const Derivative<d>& alpha) const {
  return evaluate_combination(grid, {{alpha, 1.0}});
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate_combination(const TensorGrid& grid, const Combination<d>& combination) const {
  return evaluate_combinations(grid, {combination});
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate_combinations(const TensorGrid& grid,
                                               const std::vector<Combination<d>>& combinations) const {
  return engine_->evaluate(grid, combinations);
}

template class Plan<1>;
template class Plan<2>;
template class Plan<3>;
template class Plan<4>;

}  // namespace fgtd
