#include "field/gaussians/divergence_free.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/printed.hpp"
#include "base/weight_within.hpp"

namespace gaussdrift {

namespace {

using Index = Eigen::Index;

template <int d>
fgtd::Derivative<d> plus(fgtd::Derivative<d> alpha, int axis) {
  ++alpha[static_cast<std::size_t>(axis)];
  return alpha;
}

template <int d>
fgtd::Combination<d> differentiated(fgtd::Combination<d> combination, const fgtd::Derivative<d>& alpha) {
  for (fgtd::Term<d>& term : combination)
    for (std::size_t l = 0; l < d; ++l) term.derivative[l] += alpha[l];
  return combination;
}

// a = sign b for one of the signs.
template <int d>
std::optional<double> sign_between(const fgtd::Combination<d>& a, const fgtd::Combination<d>& b) {
  for (const double sign : {1.0, -1.0})
    if (std::equal(a.begin(), a.end(), b.begin(), b.end(), [sign](const auto& p, const auto& q) {
          return p.derivative == q.derivative && p.coefficient == sign * q.coefficient;
        }))
      return sign;
  return {};
}

template <int d>
fgtd::Plan<d> make_plan(const fgtd::Points<d>& points, const Eigen::MatrixXd& coefficients, double sigma,
                        const GaussianSumOptions& options) {
  return fgtd::Plan<d>(points, coefficients, sigma,
                       {.tolerance = options.tolerance,
                        .derivative_order = options.derivative_order,
                        .method = options.method,
                        .threads = options.threads,
                        .expected_targets = options.expected_targets,
                        .hermite = options.hermite});
}

// Seconds of one pair on one thread, measured with bench_gaussian_pairs on an AVX2 core; compared with what fgtd
// predicts.
constexpr double pair_seconds = 1.6e-9;

}  // namespace

template <int d>
std::vector<MatrixEntry<d>> matrix_entries(GaussianMatrix matrix) {
  std::vector<MatrixEntry<d>> entries;
  const auto derivative = [](std::initializer_list<int> axes) {
    fgtd::Derivative<d> alpha{};
    for (const int axis : axes) alpha = plus<d>(alpha, axis);
    return alpha;
  };
  if (matrix == GaussianMatrix::curl) {
    if constexpr (d == 2) return {{0, 0, {{derivative({1}), 1.0}}}, {1, 0, {{derivative({0}), -1.0}}}};
    for (int i = 0; i < d; ++i) {
      const int j = (i + 1) % d, k = (i + 2) % d;
      entries.push_back({i, k, {{derivative({j}), 1.0}}});
      entries.push_back({i, j, {{derivative({k}), -1.0}}});
    }
    return entries;
  }
  if (matrix == GaussianMatrix::vorticity && d == 2)
    return {{0, 0, {{derivative({0, 0}), -1.0}, {derivative({1, 1}), -1.0}}}};
  for (int i = 0; i < d; ++i)
    for (int j = 0; j < d; ++j) {
      MatrixEntry<d> entry{i, j, {}};
      if (i != j) {
        entry.combination.push_back({derivative({i, j}), 1.0});
      } else {
        for (int k = 0; k < d; ++k)
          if (k != i) entry.combination.push_back({derivative({k, k}), -1.0});
      }
      entries.push_back(entry);
    }
  return entries;
}

template <int d>
GaussianSum<d>::GaussianSum(const fgtd::Points<d>& points, const Eigen::MatrixXd& coefficients, double sigma,
                            const GaussianSumOptions& options)
    : coefficients_(coefficients),
      sigma_(sigma),
      threads_(options.threads),
      plan_(make_plan<d>(points, coefficients, sigma, options)) {
  const auto count = static_cast<std::size_t>(points.cols());
  position_.resize(d * count);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t l = 0; l < d; ++l) position_[l * count + k] = points(static_cast<Index>(l), static_cast<Index>(k));
  const auto pairs = static_cast<double>(count) * static_cast<double>(plan_.choice().targets);
  pairwise_ =
      plan_.choice().method == fgtd::Method::direct ||
      (options.method == fgtd::Method::automatic && !options.hermite && pairs * pair_seconds < plan_.choice().seconds);
}

template <int d>
Eigen::MatrixXd GaussianSum<d>::sum_entries(const std::vector<MatrixEntry<d>>& entries, int rows,
                                            const fgtd::Points<d>& targets, const fgtd::Derivative<d>& alpha) const {
  // Entries that differ by a sign, as those below and above the diagonal, are evaluated once.
  std::vector<fgtd::Combination<d>> combinations;
  struct Use {
    std::size_t combination;
    double sign;
  };
  std::vector<Use> uses;
  for (const MatrixEntry<d>& entry : entries) {
    const fgtd::Combination<d> wanted = differentiated<d>(entry.combination, alpha);
    Use use{combinations.size(), 1};
    for (std::size_t q = 0; q < combinations.size(); ++q)
      if (const auto sign = sign_between<d>(wanted, combinations[q])) use = {q, *sign};
    if (use.combination == combinations.size()) combinations.push_back(wanted);
    uses.push_back(use);
  }
  const Eigen::MatrixXd values = plan_.evaluate_combinations(targets, combinations);
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(targets.cols(), rows);
  for (std::size_t e = 0; e < entries.size(); ++e)
    sum.col(entries[e].row) +=
        uses[e].sign * values.col(static_cast<Index>(uses[e].combination) * coefficients_.cols() + entries[e].column);
  return sum;
}

template <int d>
Eigen::MatrixXd GaussianSum<d>::evaluate(GaussianMatrix matrix, const fgtd::Points<d>& targets,
                                         const fgtd::Derivative<d>& alpha) const {
  const int rows = gaussian_rows(matrix, d);
  if (!pairwise_ || alpha != fgtd::Derivative<d>{}) return sum_entries(matrix_entries<d>(matrix), rows, targets, alpha);
  const Eigen::MatrixXd target = targets.transpose();
  Eigen::MatrixXd values(targets.cols(), rows);
  sum_gaussian_pairs({.matrix = matrix,
                      .dimension = d,
                      .sigma = sigma_,
                      .sources = static_cast<std::size_t>(coefficients_.rows()),
                      .position = position_.data(),
                      .coefficients = coefficients_.data(),
                      .targets = static_cast<std::size_t>(targets.cols()),
                      .target = target.data(),
                      .target_stride = static_cast<std::size_t>(target.rows()),
                      .values = values.data(),
                      .value_stride = static_cast<std::size_t>(values.rows())},
                     threads_);
  return values;
}

template <int d>
Eigen::VectorXd GaussianSum<d>::component(GaussianMatrix matrix, int row, const fgtd::Points<d>& targets,
                                          const fgtd::Derivative<d>& alpha) const {
  std::vector<MatrixEntry<d>> entries = matrix_entries<d>(matrix);
  std::erase_if(entries, [row](const MatrixEntry<d>& entry) { return entry.row != row; });
  for (MatrixEntry<d>& entry : entries) entry.row = 0;
  return sum_entries(entries, 1, targets, alpha);
}

template <int d>
Divergence GaussianSum<d>::divergence(GaussianMatrix matrix, const fgtd::Points<d>& targets,
                                      const fgtd::Derivative<d>& alpha) const {
  const std::vector<MatrixEntry<d>> entries = matrix_entries<d>(matrix);
  std::vector<fgtd::Combination<d>> combinations;
  for (const MatrixEntry<d>& entry : entries)
    combinations.push_back(differentiated<d>(entry.combination, plus<d>(alpha, entry.row)));
  const Eigen::MatrixXd values = plan_.evaluate_combinations(targets, combinations);
  Divergence result{Eigen::VectorXd::Zero(targets.cols()), Eigen::VectorXd::Zero(targets.cols())};
  for (std::size_t e = 0; e < entries.size(); ++e) {
    const auto term = values.col(static_cast<Index>(e) * coefficients_.cols() + entries[e].column);
    result.value += term;
    result.terms += term.cwiseAbs();
  }
  return result;
}

template <int d>
void GaussianSum<d>::set_coefficients(const Eigen::MatrixXd& coefficients) {
  plan_.set_weights(coefficients);
  coefficients_ = coefficients;
}

template <int d>
double GaussianSum<d>::unit_error(GaussianMatrix matrix) const {
  // The largest value of every entry for a unit coefficient, then the largest row a source.
  Eigen::MatrixXd scale = Eigen::MatrixXd::Zero(coefficients_.cols(), gaussian_rows(matrix, d));
  for (const MatrixEntry<d>& entry : matrix_entries<d>(matrix))
    for (const fgtd::Term<d>& term : entry.combination)
      scale(entry.column, entry.row) += std::abs(term.coefficient) * fgtd::derivative_scale<d>(term.derivative, sigma_);
  const Eigen::VectorXd weight = (coefficients_.cwiseAbs() * scale).rowwise().maxCoeff();
  const auto count = static_cast<std::size_t>(coefficients_.rows());
  PointsView points{d, count, {}};
  for (std::size_t l = 0; l < d; ++l) points.axis[l] = position_.data() + l * count;
  // The reach of the promise at the smallest tolerance, see fgtd::Plan.
  const double reach = std::sqrt((2 * std::log(1 / fgtd::smallest_tolerance) + 40) / sigma_);
  return largest_weight_within(points, weight.data(), reach);
}

template <int d>
std::string GaussianSum<d>::choice() const {
  if (pairwise_) return fmt::format("pair by pair, {} sources", coefficients_.rows());
  return base::printed(plan_.choice());
}

template std::vector<MatrixEntry<2>> matrix_entries<2>(GaussianMatrix);
template std::vector<MatrixEntry<3>> matrix_entries<3>(GaussianMatrix);
template class GaussianSum<2>;
template class GaussianSum<3>;

}  // namespace gaussdrift
