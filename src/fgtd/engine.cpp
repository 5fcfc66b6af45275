#include "fgtd/engine.hpp"

#include <utility>
#include <vector>

#include "fgtd/arguments.hpp"
#include "fgtd/check.hpp"
#include "fgtd/choose.hpp"

namespace fgtd::detail {

using gaussdrift::core::Buffer;

template <int d>
Engine<d>::Engine(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights,
                  double sigma, const Options& options)
    : sigma_(sigma), options_(options), sources_(static_cast<std::size_t>(sources.cols())) {
  check_sigma(sigma);
  check_options(options, d);
  check_points("source", sources.data(), d, sources_, stride<d>(sources), options.threads);
  check_weights(weights, sources_, options.threads);

  const std::size_t columns = static_cast<std::size_t>(weights.cols());
  check_memory("the plan", 8.0 * static_cast<double>(sources_) * static_cast<double>(d + columns),
               options.memory_limit);
  Buffer<double> position = by_axis<d>(sources.data(), sources_, stride<d>(sources), options.threads);

  Proposal<d> chosen = choose<d>(position, sources_, columns, sigma, options);
  check_memory("the plan", chosen.plan_bytes, options.memory_limit);
  check_seconds(chosen.choice, options.most_seconds);
  choice_ = chosen.choice;
  summation_ = chosen.make(std::move(position));
  summation_->count(choice_);
  take_weights(weights);
}

template <int d>
void Engine<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  check_weights(weights, sources_, options_.threads);
  take_weights(weights);
}

template <int d>
void Engine<d>::take_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  const std::size_t columns = static_cast<std::size_t>(weights.cols());
  const bool gaps = columns > 1 && weights.outerStride() != weights.rows();
  check_memory("the plan",
               summation_->plan_bytes(columns) +
                   (gaps ? 8.0 * static_cast<double>(sources_) * static_cast<double>(columns) : 0.0),
               options_.memory_limit);
  columns_ = columns;
  if (!gaps) {
    summation_->set_weights(weights.data(), columns);
    return;
  }
  const Eigen::MatrixXd packed = weights;  // there are gaps between its columns
  summation_->set_weights(packed.data(), columns);
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const Eigen::Ref<const Points<d>>& targets,
                                    const std::vector<Combination<d>>& combinations) const {
  const std::size_t count = static_cast<std::size_t>(targets.cols());
  check_points("target", targets.data(), d, count, stride<d>(targets), options_.threads);
  const Request<d> request = make_request<d>(combinations, sigma_, options_.derivative_order);
  const std::size_t outputs = combinations.size() * columns_;
  const bool gaps = stride<d>(targets) != d;
  check_memory("evaluation",
               summation_->plan_bytes(columns_) + summation_->point_bytes(request, count) +
                   8.0 * static_cast<double>(count) * static_cast<double>(outputs + (gaps ? d : 0)),
               options_.memory_limit);
  Eigen::MatrixXd values = make_result(count, outputs);
  if (!gaps) {
    summation_->evaluate(request, targets.data(), count, values.data());
    return values;
  }
  const Points<d> packed = targets;
  summation_->evaluate(request, packed.data(), count, values.data());
  return values;
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const {
  check_grid("grid", grid, d);
  const Request<d> request = make_request<d>(combinations, sigma_, options_.derivative_order);
  const std::size_t outputs = combinations.size() * columns_;
  double nodes = 1;
  for (const auto& axis : grid.axes) nodes *= static_cast<double>(axis.size());
  const double held = summation_->plan_bytes(columns_) + 8.0 * nodes * static_cast<double>(outputs);
  check_memory("evaluation", held, options_.memory_limit);
  check_memory("evaluation", held + summation_->grid_bytes(request, grid), options_.memory_limit);
  Eigen::MatrixXd values = make_result(grid.size(), outputs);
  summation_->evaluate(request, grid, values.data());
  return values;
}

template class Engine<1>;
template class Engine<2>;
template class Engine<3>;
template class Engine<4>;

}  // namespace fgtd::detail
