#include "field/samples/sampled_velocity.hpp"

#include <limits>
#include <mutex>
#include <optional>

#include "base/nan.hpp"
#include "field/samples/direct_sum.hpp"

namespace gaussdrift {

namespace {

using Index = Eigen::Index;

using base::nan;
// Calls with fewer points are sums over all pairs, which are as quick then.
constexpr std::size_t few_points = 512;

template <int d>
std::vector<rbf::Combination<d>> gradient() {
  std::vector<rbf::Combination<d>> along;
  for (std::size_t l = 0; l < d; ++l) {
    rbf::Derivative<d> alpha{};
    alpha[l] = 1;
    along.push_back({{alpha, 1.0}});
  }
  return along;
}

/// One function for each component. Derivatives are sums of their own, made when they are first asked for.
template <int d>
class ByComponent {
 public:
  ByComponent(const SampleFit& fit, std::size_t expected_targets)
      : fit_(fit), expected_targets_(expected_targets), pairs_(direct_sum<d>(fit, 0)) {
    rbf::Evaluator<d> chosen = fast(0);
    if (chosen.choice().method != rbf::Method::direct) fast_.emplace(std::move(chosen));
  }
  bool pairwise() const { return !fast_; }
  /// Column k: component k.
  Eigen::MatrixXd values(const rbf::Points<d>& points) const {
    return (is_many(points) ? *fast_ : pairs_).evaluate(points);
  }
  /// Column k + d l: d component k / d x_l.
  Eigen::MatrixXd slopes(const rbf::Points<d>& points) const {
    const bool many = is_many(points);
    Slopes& made = many ? fast_slopes_ : slopes_;
    std::call_once(made.once, [&] { made.sum.emplace(many ? fast(1) : direct_sum<d>(fit_, 1)); });
    return made.sum->evaluate_combinations(points, gradient<d>());
  }

 private:
  struct Slopes {
    std::once_flag once;
    std::optional<rbf::Evaluator<d>> sum;
  };
  bool is_many(const rbf::Points<d>& points) const {
    return fast_ && static_cast<std::size_t>(points.cols()) > few_points;
  }
  rbf::Evaluator<d> fast(int derivative_order) const {
    const auto& function = std::get<rbf::Interpolant<d>>(fit_.function);
    return function.evaluator(range_of_box<d>(fit_, function.points()), derivative_order, expected_targets_);
  }

  const SampleFit& fit_;
  std::size_t expected_targets_;
  rbf::Evaluator<d> pairs_;
  std::optional<rbf::Evaluator<d>> fast_;
  mutable Slopes slopes_, fast_slopes_;
};

/// One matrix kernel for all components.
template <int d>
class WithoutDivergence {
 public:
  WithoutDivergence(const SampleFit& fit, std::size_t /*expected_targets*/)
      : function_(std::get<rbf::DivergenceFreeInterpolant<d>>(fit.function)) {}
  bool pairwise() const { return true; }
  Eigen::MatrixXd values(const rbf::Points<d>& points) const { return function_.evaluate(points); }
  Eigen::MatrixXd slopes(const rbf::Points<d>& points) const { return function_.gradient(points); }

 private:
  const rbf::DivergenceFreeInterpolant<d>& function_;
};

template <int d, class Sum>
class SampledVelocity : public VelocityField {
 public:
  SampledVelocity(std::shared_ptr<const SampleFit> fit, Outside outside, std::size_t expected_targets)
      : fit_(std::move(fit)), box_(*fit_, outside), sum_(*fit_, expected_targets) {}

  void add(double /*t*/, const PointsView& x, const VectorsView& u) const override {
    const SampleBox::Placed placed = box_.place(x);
    for (const std::size_t i : placed.lost)
      for (std::size_t k = 0; k < d; ++k) u.axis[k][i] = nan;
    if (placed.index.empty()) return;
    const Eigen::MatrixXd values = sum_.values(points_of<d>(placed));
    for (std::size_t k = 0; k < d; ++k)
      for (std::size_t i = 0; i < placed.index.size(); ++i)
        u.axis[k][placed.index[i]] += values(static_cast<Index>(i), static_cast<Index>(k));
  }
  void add_divergence(double /*t*/, const PointsView& x, double* values) const override {
    const auto lost = [&](std::size_t i) { values[i] = nan; };
    if (is_solenoidal()) {  // by its form: not what rounding would leave of a sum
      for (const std::size_t i : box_.place(x).lost) lost(i);
      return;
    }
    visit_slopes(x, lost, [&](std::size_t i, std::size_t k, std::size_t l, double slope) {
      if (k == l) values[i] += slope;
    });
  }
  void add_gradient(double /*t*/, const PointsView& x, const GradientsView& gradients) const override {
    visit_slopes(
        x,
        [&](std::size_t i) {
          for (std::size_t k = 0; k < d; ++k)
            for (std::size_t l = 0; l < d; ++l) gradients.slope[k][l][i] = nan;
        },
        [&](std::size_t i, std::size_t k, std::size_t l, double slope) { gradients.slope[k][l][i] += slope; });
  }
  bool is_steady() const override { return true; }
  bool is_smooth() const override { return fit_->is_smooth() && box_.outside() == Outside::error; }
  bool is_solenoidal() const override { return fit_->is_divergence_free() && box_.outside() == Outside::error; }
  bool evaluates_in_blocks() const override { return sum_.pairwise(); }
  double cost() const override { return cost_of_pairs(*fit_); }
  bool is_fitted() const override { return true; }
  double fit_error(const PointsView& near) const override { return fit_->errors.near(near); }
  std::string why_not_finite(double /*t*/, const Vector& x) const override { return box_.why_lost(x); }
  std::string describe() const override { return "u = " + gaussdrift::describe(*fit_); }

 private:
  /// lost(i) where there is no value, slope(i, k, l, d u_k / d x_l) elsewhere.
  template <class Lost, class Slope>
  void visit_slopes(const PointsView& x, const Lost& lost, const Slope& slope) const {
    const SampleBox::Placed placed = box_.place(x);
    for (const std::size_t i : placed.lost) lost(i);
    if (placed.index.empty()) return;
    const Eigen::MatrixXd slopes = sum_.slopes(points_of<d>(placed));
    for (std::size_t l = 0; l < d; ++l)
      for (std::size_t i = 0; i < placed.index.size(); ++i) {
        if (!box_.varies(static_cast<int>(l), x.axis[l][placed.index[i]])) continue;
        for (std::size_t k = 0; k < d; ++k)
          slope(placed.index[i], k, l, slopes(static_cast<Index>(i), static_cast<Index>(k + d * l)));
      }
  }

  std::shared_ptr<const SampleFit> fit_;
  SampleBox box_;
  Sum sum_;
};

template <int d>
std::unique_ptr<VelocityField> make_in(std::shared_ptr<const SampleFit> fit, Outside outside,
                                       std::size_t expected_targets) {
  if (fit->is_divergence_free())
    return std::make_unique<SampledVelocity<d, WithoutDivergence<d>>>(std::move(fit), outside, expected_targets);
  return std::make_unique<SampledVelocity<d, ByComponent<d>>>(std::move(fit), outside, expected_targets);
}

}  // namespace

std::unique_ptr<VelocityField> make_sampled_velocity(std::shared_ptr<const SampleFit> fit, Outside outside,
                                                     std::size_t expected_targets) {
  return fit->dimension == 2 ? make_in<2>(std::move(fit), outside, expected_targets)
                             : make_in<3>(std::move(fit), outside, expected_targets);
}

}  // namespace gaussdrift
