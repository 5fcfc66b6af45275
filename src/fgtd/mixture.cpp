// The public class: forwards to its engine.
#include "fgtd/mixture.hpp"

#include "fgtd/mixture_engine.hpp"

namespace fgtd {

template <int d>
Mixture<d>::Mixture(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights,
                    std::vector<Gaussian> gaussians, const Options& options)
    : engine_(std::make_unique<detail::MixtureEngine<d>>(sources, weights, std::move(gaussians), options)) {}

template <int d>
Mixture<d>::~Mixture() = default;
template <int d>
Mixture<d>::Mixture(Mixture&&) noexcept = default;
template <int d>
Mixture<d>& Mixture<d>::operator=(Mixture&&) noexcept = default;

template <int d>
void Mixture<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  engine_->set_weights(weights);
}

template <int d>
const std::vector<Choice>& Mixture<d>::choices() const {
  return engine_->choices();
}

template <int d>
const std::vector<std::size_t>& Mixture<d>::groups() const {
  return engine_->groups();
}

template <int d>
Eigen::MatrixXd Mixture<d>::evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                                  const std::vector<Combination<d>>& combinations) const {
  return engine_->evaluate(targets, combinations);
}

template <int d>
Eigen::MatrixXd Mixture<d>::evaluate_combinations(const TensorGrid& grid,
                                                  const std::vector<Combination<d>>& combinations) const {
  return engine_->evaluate(grid, combinations);
}

template class Mixture<1>;
template class Mixture<2>;
template class Mixture<3>;
template class Mixture<4>;

}  // namespace fgtd
