// The public class: forwards to what evaluates it.
#include "farfield/engine.hpp"
#include "farfield/farfield.hpp"
#include "farfield/images/folded_sum.hpp"

namespace farfield {

namespace {

template <int d>
std::unique_ptr<detail::Evaluator<d>> evaluator(Kernel kernel, const Eigen::Ref<const Points<d>>& sources,
                                                const Eigen::Ref<const Points<d>>* targets, const Options& options) {
  if constexpr (d > 1)
    if (detail::has_copies(options)) return std::make_unique<detail::FoldedSum<d>>(kernel, sources, targets, options);
  return std::make_unique<detail::Engine<d>>(kernel, sources, targets, options);
}

}  // namespace

template <int d>
Plan<d>::Plan(Kernel kernel, const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Points<d>>& targets,
              const Options& options)
    : evaluator_(evaluator<d>(kernel, sources, &targets, options)) {}

template <int d>
Plan<d>::Plan(Kernel kernel, const Eigen::Ref<const Points<d>>& points, const Options& options)
    : evaluator_(evaluator<d>(kernel, points, nullptr, options)) {}

template <int d>
Plan<d>::Plan(Kernel kernel, const Eigen::Ref<const Points<d>>& points, std::span<const std::int64_t> numbers,
              const Options& options, Ranks& ranks)
    : evaluator_(std::make_unique<detail::Engine<d>>(kernel, points, numbers, options, ranks)) {}

template <int d>
Plan<d>::~Plan() = default;
template <int d>
Plan<d>::Plan(Plan&&) noexcept = default;
template <int d>
Plan<d>& Plan<d>::operator=(Plan&&) noexcept = default;

template <int d>
Values<d> Plan<d>::evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds* seconds) const {
  Seconds spent;
  Values<d> values = evaluator_->evaluate(charges, spent);
  if (seconds) *seconds = spent;
  return values;
}

template <int d>
const Choice& Plan<d>::choice() const {
  return evaluator_->choice();
}

template <int d>
Received Plan<d>::received() const {
  return evaluator_->received();
}

template class Plan<1>;
template class Plan<2>;
template class Plan<3>;

}  // namespace farfield
