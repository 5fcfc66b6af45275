// The public class: forwards to its engine.
#include "rbf/engine.hpp"
#include "rbf/rbf.hpp"

namespace rbf {

template <int d>
Plan<d>::Plan(const Function& function, const Eigen::Ref<const Points<d>>& centres,
              const Eigen::Ref<const Eigen::MatrixXd>& weights, const Options& options)
    : engine_(std::make_unique<detail::Engine<d>>(function, centres, weights, options)) {}

template <int d>
Plan<d>::~Plan() = default;
template <int d>
Plan<d>::Plan(Plan&&) noexcept = default;
template <int d>
Plan<d>& Plan<d>::operator=(Plan&&) noexcept = default;

template <int d>
Eigen::MatrixXd Plan<d>::evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha) const {
  return engine_->evaluate(targets, {{{alpha, 1.0}}});
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate(const TensorGrid& grid, const Derivative<d>& alpha) const {
  return engine_->evaluate(grid, {{{alpha, 1.0}}});
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                               const std::vector<Combination<d>>& combinations) const {
  return engine_->evaluate(targets, combinations);
}

template <int d>
Eigen::MatrixXd Plan<d>::evaluate_combinations(const TensorGrid& grid,
                                               const std::vector<Combination<d>>& combinations) const {
  return engine_->evaluate(grid, combinations);
}

template <int d>
void Plan<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  engine_->set_weights(weights);
}

template <int d>
const Choice& Plan<d>::choice() const {
  return engine_->choice();
}

template class Plan<1>;
template class Plan<2>;
template class Plan<3>;

}  // namespace rbf
