// A Plan's inside: checks, chooses the method, and passes the work on.
#include "fgtd/engine.hpp"

#include <cmath>

#include "fgtd/check.hpp"
#include "fgtd/choose.hpp"

namespace fgtd::detail {
namespace {

/// Numbers from one point to the next. One-dimensional points are a row, which Eigen keeps row-major.
template <int d>
std::size_t stride(const Eigen::Ref<const Points<d>>& points) {
  return d == 1 ? 1 : static_cast<std::size_t>(points.outerStride());
}

}  // namespace

template <int d>
Engine<d>::Engine(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights,
                  double sigma, const Options& options)
    : sigma_(sigma), options_(options) {
  check_sigma(sigma);
  check_options(options, d);
  const std::size_t count = static_cast<std::size_t>(sources.cols());
  check_points("source", sources.data(), d, count, stride<d>(sources));
  check_weights(weights, count);

  sources_.count = count;
  sources_.columns = static_cast<std::size_t>(weights.cols());
  check_memory("the plan", plan_bytes(sources_.columns), options.memory_limit);
  sources_.position.resize(d * count);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t l = 0; l < d; ++l)
      sources_.position[l * count + j] = sources(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(j));

  const Decision decision = choose<d>(sources_, sigma, options);
  choice_ = decision.choice;
  if (choice_.method == Method::hermite) {
    check_memory("the plan", plan_bytes(sources_.columns) + 8.0 * static_cast<double>(count) * (2 * d + 4),
                 options.memory_limit);
    Boxes<d> boxes = make_boxes<d>(sources_.position, count, choice_.box_side, order_);
    choice_.boxes = boxes.count();
    hermite_.emplace(decision.hermite, sigma, std::move(boxes));
  }
  set_weights(weights);
}

template <int d>
double Engine<d>::plan_bytes(std::size_t columns) const {
  const double points = 8.0 * static_cast<double>(sources_.count) * static_cast<double>(d + columns);
  if (!hermite_) return points;
  const double moments = static_cast<double>(columns) * std::pow(hermite_->plan().terms, d);
  return points + 8.0 * static_cast<double>(order_.size()) +
         8.0 * static_cast<double>(hermite_->boxes().count()) * (moments + 3 * d);
}

template <int d>
void Engine<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  check_weights(weights, sources_.count);
  const std::size_t columns = static_cast<std::size_t>(weights.cols());
  check_memory("the plan", plan_bytes(columns), options_.memory_limit);
  sources_.columns = columns;
  sources_.weights.resize(columns * sources_.count);
  for (std::size_t k = 0; k < columns; ++k)
    for (std::size_t j = 0; j < sources_.count; ++j) {
      const std::size_t from = order_.empty() ? j : order_[j];
      sources_.weights[k * sources_.count + j] = weights(static_cast<Eigen::Index>(from), static_cast<Eigen::Index>(k));
    }
  if (hermite_) hermite_->set_moments(sources_, options_.threads);
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const Eigen::Ref<const Points<d>>& targets,
                                    const std::vector<Combination<d>>& combinations) const {
  const std::size_t count = static_cast<std::size_t>(targets.cols());
  check_points("target", targets.data(), d, count, stride<d>(targets));
  const Request<d> request = make_request<d>(combinations, sigma_, options_.derivative_order);
  const std::size_t outputs = combinations.size() * sources_.columns;
  const double own = hermite_ ? hermite_->point_bytes(request, static_cast<double>(count)) : 0.0;
  check_memory("evaluation",
               plan_bytes(sources_.columns) + own + 8.0 * static_cast<double>(count) * static_cast<double>(outputs + d),
               options_.memory_limit);
  const Points<d> packed = targets;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(outputs));
  if (hermite_) {
    hermite_->evaluate(request, packed.data(), count, options_.threads, values.data());
  } else {
    evaluate_direct<d>(sources_, sigma_, request, packed.data(), count, options_.threads, values.data());
  }
  return values;
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const {
  check_grid("grid", grid, d);
  const Request<d> request = make_request<d>(combinations, sigma_, options_.derivative_order);
  const std::size_t outputs = combinations.size() * sources_.columns;
  double nodes = 1;
  for (const auto& axis : grid.axes) nodes *= static_cast<double>(axis.size());
  const double needed = plan_bytes(sources_.columns) + 8.0 * nodes * static_cast<double>(outputs);
  check_memory("evaluation", needed, options_.memory_limit);
  if (hermite_) check_memory("evaluation", needed + hermite_->grid_bytes(request, grid), options_.memory_limit);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(grid.size()), static_cast<Eigen::Index>(outputs));
  if (hermite_) {
    hermite_->evaluate(request, grid, options_.threads, values.data());
  } else {
    evaluate_direct<d>(sources_, sigma_, request, grid, options_.threads, values.data());
  }
  return values;
}

template class Engine<1>;
template class Engine<2>;
template class Engine<3>;
template class Engine<4>;

}  // namespace fgtd::detail
