// A Plan's inside: checks, chooses the method, and passes the work on.
#include "fgtd/engine.hpp"

#include <cmath>

#include "fgtd/check.hpp"

namespace fgtd::detail {
namespace {

/// Numbers from one point to the next. One-dimensional points are a row, which Eigen keeps row-major.
template <int d>
std::size_t stride(const Eigen::Ref<const Points<d>>& points) {
  return d == 1 ? 1 : static_cast<std::size_t>(points.outerStride());
}

}  // namespace

template <int d>
Engine<d>::Engine(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights, double sigma,
                  const Options& options)
    : sigma_(sigma), options_(options) {
  check_sigma(sigma);
  check_options(options, d);
  const std::size_t count = static_cast<std::size_t>(sources.cols());
  check_points("source", sources.data(), d, count, stride<d>(sources));
  check_weights(weights, count);

  sources_.count = count;
  check_memory("the plan", plan_bytes(static_cast<std::size_t>(weights.cols())), options.memory_limit);
  sources_.position.resize(d * count);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t l = 0; l < d; ++l)
      sources_.position[l * count + j] = sources(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(j));
  choice_.sources = count;
  set_weights(weights);
}

template <int d>
double Engine<d>::plan_bytes(std::size_t columns) const {
  return 8.0 * static_cast<double>(sources_.count) * static_cast<double>(d + columns);
}

template <int d>
void Engine<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  check_weights(weights, sources_.count);
  const std::size_t columns = static_cast<std::size_t>(weights.cols());
  check_memory("the plan", plan_bytes(columns), options_.memory_limit);
  sources_.columns = columns;
  sources_.weights.resize(columns * sources_.count);
  for (std::size_t k = 0; k < columns; ++k)
    for (std::size_t j = 0; j < sources_.count; ++j)
      sources_.weights[k * sources_.count + j] = weights(static_cast<Eigen::Index>(j), static_cast<Eigen::Index>(k));
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const Eigen::Ref<const Points<d>>& targets, const std::vector<Combination<d>>& combinations) const {
  const std::size_t count = static_cast<std::size_t>(targets.cols());
  check_points("target", targets.data(), d, count, stride<d>(targets));
  const Request<d> request = make_request<d>(combinations, sigma_, options_.derivative_order);
  const std::size_t outputs = combinations.size() * sources_.columns;
  check_memory("evaluation", plan_bytes(sources_.columns) + 8.0 * static_cast<double>(count) * static_cast<double>(outputs + d),
               options_.memory_limit);
  const Points<d> packed = targets;
  Eigen::MatrixXd values(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(outputs));
  evaluate_direct<d>(sources_, sigma_, request, packed.data(), count, options_.threads, values.data());
  return values;
}

template <int d>
Eigen::MatrixXd Engine<d>::evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const {
  check_grid("grid", grid, d);
  const Request<d> request = make_request<d>(combinations, sigma_, options_.derivative_order);
  const std::size_t outputs = combinations.size() * sources_.columns;
  double nodes = 1;
  for (const auto& axis : grid.axes) nodes *= static_cast<double>(axis.size());
  check_memory("evaluation", plan_bytes(sources_.columns) + 8.0 * nodes * static_cast<double>(outputs), options_.memory_limit);
  Eigen::MatrixXd values(static_cast<Eigen::Index>(grid.size()), static_cast<Eigen::Index>(outputs));
  evaluate_direct<d>(sources_, sigma_, request, grid, options_.threads, values.data());
  return values;
}

template class Engine<1>;
template class Engine<2>;
template class Engine<3>;
template class Engine<4>;

}  // namespace fgtd::detail
