#include "rbf/expansion/fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace rbf::detail {
namespace {

// Of improved(): in all, and without progress. More steps take a few milliseconds and often save a Gauss transform.
constexpr int most_steps = 40, patience = 10;
constexpr double longest_step = 0.7;  // in the logarithm of an exponent
// Weights larger than this cancel each other: each Gauss transform would have to be as much more accurate.
constexpr double largest_weight = 50;
constexpr double finest_of_fgtd = 10 * fgtd::smallest_tolerance;  // that a Gauss transform is asked for

// Very wide Gaussians are nearly polynomials. Terms that depend on others to this accuracy get no weights that cancel.
constexpr double dependent = 1e-12;

}  // namespace

std::vector<double> samples_of_range(double near, double first, int a_decade, int even) {
  std::vector<double> samples{near * near};
  first = std::max(first, near * near);
  const int count = static_cast<int>(std::ceil(-std::log10(first) * a_decade));
  for (int i = 0; i <= count; ++i) samples.push_back(std::pow(first, 1 - static_cast<double>(i) / count));
  for (int i = 1; i < even; ++i) {
    const double r = 0.5 * (1 - std::cos(std::numbers::pi * i / even));
    if (r > near) samples.push_back(r * r);
  }
  std::sort(samples.begin(), samples.end());
  return samples;
}

Fit::Fit(const Function& function, double range, double near, int order, const Scales& scales, double finest)
    : samples_(samples_of_range(near, 1e-2 / std::max(finest, 10.0), near > 0 ? 30 : 12, 90)),
      order_(order),
      slope_(order >= 1 ? scales.of[0] / range / scales.of[1] : 0),
      curvature_(order >= 2 ? scales.of[0] / range / range / scales.of[2] : 0) {
  const KernelEntry& entry = entry_of(function.kernel);
  const std::size_t count = samples_.size(), blocks = order == 2 ? 4 : static_cast<std::size_t>(order) + 1;
  wanted_.resize(static_cast<Eigen::Index>(blocks * count));
  for (std::size_t i = 0; i < count; ++i) {
    const long double r = std::sqrt(static_cast<long double>(samples_[i])) * range, s = r * r;
    const Profile at = entry.profile(s, function.shape);
    const long double rows[] = {at.value, r > 0 ? first_derivative(at, r) : 0, 2 * at.slope, second_derivative(at, s)};
    for (std::size_t block = 0; block < blocks; ++block)
      wanted_[static_cast<Eigen::Index>(block * count + i)] =
          static_cast<double>(rows[block] / scales.of[std::min<std::size_t>(block, 2)]);
  }
}

void Fit::fill(const Eigen::VectorXd& exponents, Eigen::MatrixXd& terms, Eigen::MatrixXd* slopes) const {
  const Eigen::Index count = static_cast<Eigen::Index>(samples_.size());
  terms.resize(wanted_.size(), exponents.size() + polynomial_terms);
  if (slopes) slopes->resize(wanted_.size(), exponents.size());
  const auto put = [&](Eigen::MatrixXd& to, Eigen::Index column, Eigen::Index i, double f, double f1, double f2) {
    const double u = samples_[static_cast<std::size_t>(i)];
    to(i, column) = f;
    if (order_ >= 1) to(count + i, column) = 2 * std::sqrt(u) * f1 * slope_;
    if (order_ >= 2) {
      to(2 * count + i, column) = 2 * f1 * curvature_;
      to(3 * count + i, column) = (2 * f1 + 4 * u * f2) * curvature_;
    }
  };
  for (Eigen::Index i = 0; i < count; ++i) {
    const double u = samples_[static_cast<std::size_t>(i)];
    put(terms, 0, i, 1, 0, 0);
    put(terms, 1, i, u, 1, 0);
    put(terms, 2, i, u * u, 2 * u, 2);
  }
  for (Eigen::Index k = 0; k < exponents.size(); ++k) {
    const double t = std::exp(exponents[k]);
    for (Eigen::Index i = 0; i < count; ++i) {
      const double v = t * samples_[static_cast<std::size_t>(i)], f = std::exp(-v);
      put(terms, polynomial_terms + k, i, f, -t * f, t * t * f);
      if (slopes) put(*slopes, k, i, -v * f, -t * (1 - v) * f, t * t * (2 - v) * f);  // t d/dt
    }
  }
}

Fit::Result Fit::result(const Eigen::VectorXd& exponents, const Eigen::VectorXd& weights,
                        const Eigen::VectorXd& errors) const {
  return {exponents, weights, weights.allFinite() ? errors.cwiseAbs().maxCoeff() : HUGE_VAL};
}

Fit::Result Fit::weights_for(const Eigen::VectorXd& exponents) const {
  Eigen::MatrixXd terms;
  fill(exponents, terms, nullptr);
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> decomposition;
  decomposition.setThreshold(dependent);
  const Eigen::VectorXd weights = decomposition.compute(terms).solve(wanted_);
  return result(exponents, weights, terms * weights - wanted_);
}

/// Levenberg and Marquardt's method for the exponents; the weights that belong to them are eliminated ("variable
/// projection", [GP73] in Kaufman's form). Rows with large errors count more from step to step, as Lawson does it.
Fit::Result Fit::improved(const Eigen::VectorXd& start, double wanted) const {
  Eigen::VectorXd exponents = start, importance = Eigen::VectorXd::Ones(wanted_.size());
  Eigen::MatrixXd terms, slopes, normal;
  Eigen::VectorXd right;
  Result best;
  best.error = HUGE_VAL;
  // Each transform gets a share of about wanted / terms for its weight.
  const double heaviest = std::min(
      largest_weight, wanted / (finest_of_fgtd * static_cast<double>(std::max<Eigen::Index>(1, start.size()))));
  double damping = 1e-2, norm = HUGE_VAL;
  Eigen::VectorXd accepted = start, change;
  for (int step = 0, accepted_steps = 0, since_best = 0; step < most_steps && since_best < patience; ++step) {
    fill(exponents, terms, &slopes);
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(importance.asDiagonal() * terms);
    const Eigen::VectorXd weights = qr.solve(importance.cwiseProduct(wanted_));
    const Eigen::VectorXd errors = wanted_ - terms * weights;
    const Result now = result(exponents, weights, errors);
    const double now_norm = importance.cwiseProduct(errors).norm();
    ++since_best;
    if (now.error < best.error && weights.cwiseAbs().maxCoeff() < heaviest) {
      if (now.error < 0.97 * best.error) since_best = 0;
      best = now;
    }
    if (best.error <= wanted) break;
    if (now_norm < norm && std::isfinite(now.error)) {
      accepted = exponents;
      damping = std::max(1e-6, damping / 5);
      if (++accepted_steps >= 3) {
        importance = importance.array() * (errors.array().abs() / now.error + 0.03).sqrt();
        importance /= importance.maxCoeff();
        norm = importance.cwiseProduct(errors).norm();
      } else {
        norm = now_norm;
      }
      // What a change of an exponent does beside what the weights make good.
      slopes = importance.asDiagonal() * slopes * weights.tail(exponents.size()).asDiagonal();
      const Eigen::HouseholderQR<Eigen::MatrixXd> projection(importance.asDiagonal() * terms);
      Eigen::MatrixXd rotated = projection.householderQ().adjoint() * slopes;
      rotated.topRows(terms.cols()).setZero();
      normal = rotated.transpose() * rotated;
      right =
          rotated.transpose() * Eigen::VectorXd(projection.householderQ().adjoint() * importance.cwiseProduct(errors));
    } else {
      damping *= 8;
    }
    Eigen::MatrixXd damped = normal;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += 1e-10 * damped.diagonal().maxCoeff();
    change = damped.ldlt().solve(right);
    if (!change.allFinite()) break;
    const double longest = change.cwiseAbs().maxCoeff();
    if (longest > longest_step) change *= longest_step / longest;
    exponents = accepted + change;
    std::sort(exponents.begin(), exponents.end());
  }
  return best;
}

}  // namespace rbf::detail
