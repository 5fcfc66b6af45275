// The public classes: check the arguments, and pass the work on.
#include "rbf/interpolant.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>
#include <random>

#include "rbf/check.hpp"
#include "rbf/fit/check_fit.hpp"
#include "rbf/fit/fitted.hpp"
#include "rbf/fit/partition.hpp"

namespace rbf {
namespace {

using Index = Eigen::Index;
using detail::text;

struct Named {
  Solver solver;
  const char* name;  // as in files
};
constexpr Named solver_names[] = {{Solver::automatic, "auto"}, {Solver::dense, "dense"}, {Solver::krylov, "krylov"}};

[[noreturn]] void refuse(const std::string& what) { throw InvalidArgument("rbf: " + what); }

/// The nodes of a grid, first axis fastest.
template <int d>
Points<d> nodes_of(const TensorGrid& grid) {
  Points<d> nodes(d, static_cast<Index>(grid.size()));
  for (Index i = 0; i < nodes.cols(); ++i) {
    std::size_t rest = static_cast<std::size_t>(i);
    for (std::size_t l = 0; l < d; ++l) {
      nodes(static_cast<Index>(l), i) = grid.axes[l][rest % grid.axes[l].size()];
      rest /= grid.axes[l].size();
    }
  }
  return nodes;
}

/// The corners of a grid, which are farthest from everything.
template <int d>
Points<d> corners_of(const TensorGrid& grid) {
  TensorGrid ends;
  for (const std::vector<double>& axis : grid.axes)
    ends.axes.push_back(axis.empty() ? axis : std::vector<double>{axis.front(), axis.back()});
  return nodes_of<d>(ends);
}

template <int d>
int order_in(const std::vector<Combination<d>>& combinations) {
  int order = 0;
  for (const Combination<d>& combination : combinations)
    for (const fgtd::Term<d>& term : combination)
      order = std::max(order, std::accumulate(term.derivative.begin(), term.derivative.end(), 0));
  return order;
}

}  // namespace

std::string to_string(Solver solver) {
  for (const Named& entry : solver_names)
    if (entry.solver == solver) return entry.name;
  return solver_names[0].name;
}

const std::vector<ShapeBy>& ways_to_choose_a_shape() {
  static const std::vector<ShapeBy> all{ShapeBy::left_out, ShapeBy::likelihood};
  return all;
}

std::string to_string(ShapeBy by) { return by == ShapeBy::likelihood ? "likelihood" : "left-out"; }

std::ostream& operator<<(std::ostream& out, const FitReport& report) {
  out << to_string(report.function.kernel);
  if (takes_shape(report.function.kernel))
    out << " of shape " << report.function.shape << (report.shape_was_chosen ? " (chosen)" : "");
  out << " to " << report.points << " points by " << to_string(report.solver) << ": residual " << report.residual
      << ", condition about " << report.condition;
  if (report.solver == Solver::krylov) out << " in parts, " << report.iterations << " iterations";
  out << ", " << report.seconds << " s";
  for (std::size_t k = 0; k < report.left_out.size(); ++k)
    out << (k == 0 ? "; error of left-out values " : ", ") << report.left_out[k] << " (the values: " << report.values[k]
        << ")";
  return out;
}

template <int d>
Interpolant<d>::Interpolant(const Function& function, const Eigen::Ref<const Points<d>>& points,
                            const Eigen::Ref<const Eigen::MatrixXd>& values, const FitOptions& options) {
  if (!(takes_shape(function.kernel) && function.shape == 0)) detail::check_function(function);
  detail::check_fit_options(options);
  if (points.cols() == 0) refuse("there are no points to fit a function to");
  const Points<d> packed = points;
  detail::check_data<d>("point", packed, "values", values, options);
  detail::check_polynomials<d>(function, packed);
  fitted_ = std::make_shared<const detail::Fitted<d>>(function, packed, values, options);
}

template <int d>
Evaluator<d> Interpolant<d>::evaluator(double range, int derivative_order, std::size_t expected_targets,
                                       Method method) const {
  Options options = fitted_->evaluation(range, derivative_order, expected_targets);
  options.method = method;
  return {fitted_, options};
}

template <int d>
Eigen::MatrixXd Interpolant<d>::evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha) const {
  return evaluate_combinations(targets, {{{alpha, 1.0}}});
}

template <int d>
Eigen::MatrixXd Interpolant<d>::evaluate(const TensorGrid& grid, const Derivative<d>& alpha) const {
  return evaluate_combinations(grid, {{{alpha, 1.0}}});
}

template <int d>
Eigen::MatrixXd Interpolant<d>::evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                                      const std::vector<Combination<d>>& combinations) const {
  const Points<d> packed = targets;
  const std::size_t count = static_cast<std::size_t>(targets.cols());
  detail::check_points("target", packed.data(), d, count, d, fitted_->options().threads);
  const double range = range_of<d>(fitted_->points(), packed);
  return evaluator(range, order_in<d>(combinations), count).evaluate_combinations(targets, combinations);
}

template <int d>
Eigen::MatrixXd Interpolant<d>::evaluate_combinations(const TensorGrid& grid,
                                                      const std::vector<Combination<d>>& combinations) const {
  detail::check_grid("grid", grid, d);
  const double range = range_of<d>(fitted_->points(), corners_of<d>(grid));
  return evaluator(range, order_in<d>(combinations), grid.size()).evaluate_combinations(grid, combinations);
}

template <int d>
const Points<d>& Interpolant<d>::points() const {
  return fitted_->points();
}
template <int d>
const Eigen::MatrixXd& Interpolant<d>::weights() const {
  return fitted_->coefficients().weights;
}
template <int d>
const Eigen::MatrixXd& Interpolant<d>::polynomial() const {
  return fitted_->coefficients().polynomial;
}
template <int d>
const Eigen::MatrixXd& Interpolant<d>::left_out_errors() const {
  return fitted_->left_out_errors();
}
template <int d>
const FitReport& Interpolant<d>::report() const {
  return fitted_->report();
}

template <int d>
Evaluator<d>::Evaluator(std::shared_ptr<const detail::Fitted<d>> fitted, const Options& options)
    : fitted_(std::move(fitted)),
      plan_(fitted_->report().function, fitted_->points(), fitted_->coefficients().weights, options) {}

template <int d>
Eigen::MatrixXd Evaluator<d>::evaluate(const Eigen::Ref<const Points<d>>& targets, const Derivative<d>& alpha) const {
  return evaluate_combinations(targets, {{{alpha, 1.0}}});
}

template <int d>
Eigen::MatrixXd Evaluator<d>::evaluate(const TensorGrid& grid, const Derivative<d>& alpha) const {
  return evaluate_combinations(grid, {{{alpha, 1.0}}});
}

template <int d>
Eigen::MatrixXd Evaluator<d>::evaluate_combinations(const Eigen::Ref<const Points<d>>& targets,
                                                    const std::vector<Combination<d>>& combinations) const {
  Eigen::MatrixXd values = plan_.evaluate_combinations(targets, combinations);
  fitted_->add_polynomial(targets, combinations, values);
  return values;
}

template <int d>
Eigen::MatrixXd Evaluator<d>::evaluate_combinations(const TensorGrid& grid,
                                                    const std::vector<Combination<d>>& combinations) const {
  Eigen::MatrixXd values = plan_.evaluate_combinations(grid, combinations);
  fitted_->add_polynomial(nodes_of<d>(grid), combinations, values);
  return values;
}

template <int d>
Eigen::MatrixXd cross_validation_errors(const Function& function, const Eigen::Ref<const Points<d>>& points,
                                        const Eigen::Ref<const Eigen::MatrixXd>& values, int folds,
                                        const FitOptions& options) {
  const Index count = points.cols();
  if (folds < 2 || folds > count)
    refuse("folds = " + std::to_string(folds) + ", must lie in 2 .. the number of points, " + std::to_string(count));
  // Dealt out at random, since neighbours often follow each other; the same every time.
  std::vector<Index> order(static_cast<std::size_t>(count));
  std::iota(order.begin(), order.end(), Index{0});
  std::mt19937_64 random(1);
  for (std::size_t i = order.size() - 1; i > 0; --i) std::swap(order[i], order[random() % (i + 1)]);
  Eigen::MatrixXd errors(count, values.cols());
  for (int fold = 0; fold < folds; ++fold) {
    std::vector<Index> left_out, kept;
    for (std::size_t i = 0; i < order.size(); ++i)
      (static_cast<int>(i % static_cast<std::size_t>(folds)) == fold ? left_out : kept).push_back(order[i]);
    const Points<d> all = points;
    const Eigen::MatrixXd some_values = values(kept, Eigen::all);
    const Interpolant<d> fit(function, detail::chosen<d>(all, kept), some_values, options);
    const Eigen::MatrixXd predicted = fit.evaluate(detail::chosen<d>(all, left_out));
    for (std::size_t i = 0; i < left_out.size(); ++i)
      errors.row(left_out[i]) = predicted.row(static_cast<Index>(i)) - values.row(left_out[i]);
  }
  return errors;
}

template class Evaluator<1>;
template class Evaluator<2>;
template class Evaluator<3>;
template class Interpolant<1>;
template class Interpolant<2>;
template class Interpolant<3>;
template Eigen::MatrixXd cross_validation_errors<1>(const Function&, const Eigen::Ref<const Points<1>>&,
                                                    const Eigen::Ref<const Eigen::MatrixXd>&, int, const FitOptions&);
template Eigen::MatrixXd cross_validation_errors<2>(const Function&, const Eigen::Ref<const Points<2>>&,
                                                    const Eigen::Ref<const Eigen::MatrixXd>&, int, const FitOptions&);
template Eigen::MatrixXd cross_validation_errors<3>(const Function&, const Eigen::Ref<const Points<3>>&,
                                                    const Eigen::Ref<const Eigen::MatrixXd>&, int, const FitOptions&);

}  // namespace rbf
