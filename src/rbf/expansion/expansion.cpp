#include "rbf/expansion/expansion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "rbf/check.hpp"
#include "rbf/expansion/fit.hpp"

namespace rbf::detail {
namespace {

constexpr double step_of_integral = 0.25;  // in ln t: the ends need no accuracy
constexpr double most_decades = 30;        // of exponents on either side of 1/R^2
constexpr int most_terms = 160;
constexpr int attempts = 6;
constexpr double aimed_at = 0.9, end_part = 0.25;  // of the accuracy: of the fit, of what lies beyond the ends

/// Largest |d^j/dr^j exp(-t r^2)|.
double largest_derivative(int j, double t) {
  if (j == 0) return 1;
  return j == 1 ? std::sqrt(2 * t / std::numbers::e) : 2 * t;
}

/// Logarithms of exponents in units of 1/R^2.
struct Ends {
  double low = 0, high = 0;
};

/// The ends between which the integral over Gaussians has to be taken: what lies above adds less than `accuracy` to the
/// kernel and its derivatives, what lies below less than that beside 1, r^2 and r^4.
Ends ends_of_integral(const Function& function, double range, int order, const Scales& scales, double accuracy) {
  const KernelEntry& entry = entry_of(function.kernel);
  const double squared = range * range;
  const int steps = static_cast<int>(most_decades * std::numbers::ln10 / step_of_integral);
  const auto amount = [&](int i) {  // rho(t) dt, t in units of 1/R^2
    const double t = std::exp(step_of_integral * i) / squared;
    return step_of_integral * t * entry.density(t, function.shape);
  };
  int high = steps;
  double above[3] = {};
  for (; high > -steps; --high) {
    const double t = std::exp(step_of_integral * high) / squared;
    bool small = true;
    for (int j = 0; j <= order; ++j) {
      above[j] += amount(high) * largest_derivative(j, t);
      small = small && above[j] < accuracy * scales.of[j];
    }
    if (!small) break;
  }
  int low = -steps;
  for (double below = 0; low < high; ++low) {
    const double t = std::exp(step_of_integral * low);
    below += amount(low) * std::min(1.0, t * t * t / 6);
    if (!(below < accuracy * scales.of[0])) break;
  }
  return {step_of_integral * low, step_of_integral * high};
}

Eigen::VectorXd even_steps(const Ends& ends, int terms) {
  return Eigen::VectorXd::LinSpaced(terms, ends.low, ends.high);  // one term: the upper end
}

/// Ways to begin with one exponent less: spaced like those before, in even steps, without the last, without the first.
std::vector<Eigen::VectorXd> one_less(const Eigen::VectorXd& exponents) {
  const Eigen::Index terms = exponents.size() - 1;
  Eigen::VectorXd alike(terms);
  for (Eigen::Index k = 0; k < terms; ++k) {
    const double place = (static_cast<double>(k) + 0.5) * (1 + 1 / static_cast<double>(terms)) - 0.5;
    const Eigen::Index before = std::clamp<Eigen::Index>(static_cast<Eigen::Index>(place), 0, terms - 1);
    const double part = place - static_cast<double>(before);
    alike[k] = (1 - part) * exponents[before] + part * exponents[before + 1];
  }
  return {alike, even_steps({exponents[0], exponents[terms]}, static_cast<int>(terms)), exponents.head(terms),
          exponents.tail(terms)};
}

/// The largest number of terms that can be removed in one way.
template <class Good>
int most_removed(int terms, const Good& good) {
  int possible = 0, impossible = terms;
  while (impossible - possible > 1) {
    const int middle = (possible + impossible) / 2;
    (good(middle) ? possible : impossible) = middle;
  }
  return possible;
}

/// Few exponents with an error of at most `accuracy`: those of the trapezoidal rule first, then fewer and fewer. Moving
/// them takes most of the time, and is left out if evenly spaced ones will do.
std::optional<Fit::Result> fewest(const Fit& fit, Ends ends, double accuracy, Exponents exponents) {
  const Fit::Result polynomial = fit.weights_for(Eigen::VectorXd(0));
  if (polynomial.error <= accuracy) return polynomial;
  // The trapezoidal rule in ln t with step h errs by about exp(-pi^2 / h).
  double step = std::numbers::pi * std::numbers::pi / std::log(4 / accuracy);
  int terms = 0;
  const auto good = [&](const Ends& between, int count) {
    return fit.weights_for(even_steps(between, count)).error <= accuracy;
  };
  for (int attempt = 0;; ++attempt, step *= 0.85) {
    terms = 2 + static_cast<int>((ends.high - ends.low) / step);
    if (terms > most_terms || attempt > 8) return {};
    if (good(ends, terms)) break;
  }
  const auto rung = [&](int k) { return ends.low + (ends.high - ends.low) * k / std::max(1, terms - 1); };
  const int low = most_removed(terms, [&](int removed) { return good({rung(removed), ends.high}, terms - removed); });
  ends.low = rung(low);
  terms -= low;
  const int high = most_removed(terms, [&](int removed) {
    return good({ends.low, rung(terms - 1 - removed)}, terms - removed);
  });
  ends.high = rung(terms - 1 - high);
  terms -= high;
  terms -= most_removed(terms, [&](int removed) { return good(ends, terms - removed); });
  Fit::Result best = fit.weights_for(even_steps(ends, terms));
  for (bool found = exponents == Exponents::fewest; found && best.exponents.size() > 1;) {
    found = false;
    for (const Eigen::VectorXd& start : one_less(best.exponents)) {
      const Fit::Result fewer = fit.improved(start, accuracy);
      found = fewer.error <= accuracy;
      if (!found) continue;
      best = fewer;
      break;
    }
  }
  return best;
}

/// The largest error of value and derivatives, relative to their scales, in long double on three times as many samples.
double measured_error(const Function& function, double range, double near, int order, double finest,
                      const Expansion& sum) {
  const KernelEntry& entry = entry_of(function.kernel);
  long double worst = 0;
  for (const double u : samples_of_range(near / range, 1e-3 / std::max(finest, 10.0), 43, 250)) {
    const long double r = std::sqrt(static_cast<long double>(u)) * range, s = r * r;
    const Profile exact = entry.profile(s, function.shape);
    const Profile found = sum.profile(s);
    worst = std::max(worst, std::abs(found.value - exact.value) / sum.scales.of[0]);
    if (order >= 1 && r > 0)
      worst = std::max(worst, std::abs(first_derivative(found, r) - first_derivative(exact, r)) / sum.scales.of[1]);
    if (order >= 2)
      worst = std::max({worst, std::abs(2 * (found.slope - exact.slope)) / sum.scales.of[2],
                        std::abs(second_derivative(found, s) - second_derivative(exact, s)) / sum.scales.of[2]});
  }
  return static_cast<double>(worst);
}

}  // namespace

Profile Expansion::profile(long double s) const {
  Profile found{polynomial[0] + s * (polynomial[1] + s * polynomial[2]), polynomial[1] + 2 * s * polynomial[2],
                2 * polynomial[2]};
  for (const WeightedGaussian& term : terms) {
    const long double t = term.exponent, f = t * s < 60 ? term.weight * std::exp(-t * s) : 0;
    found.value += f;
    found.slope -= t * f;
    found.curvature += t * t * f;
  }
  return found;
}

double finest_exponent(const Function& function, double range, int order, double accuracy) {
  if (function.kernel == Kernel::gaussian) return 1 / (function.shape * function.shape);
  const Scales scales = largest(function, range, order);
  return std::exp(ends_of_integral(function, range, order, scales, end_part * aimed_at * accuracy).high) / range /
         range;
}

Expansion expand(const Function& function, double range, double near, int order, double accuracy, Exponents exponents) {
  Expansion sum;
  sum.scales = largest(function, range, order);
  const double squared = range * range;
  if (function.kernel == Kernel::gaussian) {
    sum.terms = {{1 / (function.shape * function.shape), 1}};
    return sum;
  }
  double aim = aimed_at * accuracy;
  for (int attempt = 0; attempt < attempts; ++attempt, aim *= 0.7) {
    Ends ends = ends_of_integral(function, range, order, sum.scales, end_part * aim);
    if (near > 0) ends.high = std::min(ends.high, std::log(gone * squared / (near * near)));
    ends.low = std::min(ends.low, ends.high);
    const double finest = std::exp(ends.high);
    const Fit fit(function, range, near / range, order, sum.scales, finest);
    const std::optional<Fit::Result> result = fewest(fit, ends, aim, exponents);
    if (!result) break;
    for (int i = 0; i < polynomial_terms; ++i)
      sum.polynomial[static_cast<std::size_t>(i)] = result->weights[i] * sum.scales.of[0] / std::pow(squared, i);
    sum.terms.clear();
    for (Eigen::Index k = 0; k < result->exponents.size(); ++k)
      sum.terms.push_back(
          {std::exp(result->exponents[k]) / squared, result->weights[k + polynomial_terms] * sum.scales.of[0]});
    sum.error = measured_error(function, range, near, order, finest, sum);
    if (sum.error <= accuracy) return sum;
  }
  throw ToleranceError("rbf: no sum of Gaussians is as close to " + to_string(function.kernel) + " with shape " +
                       text(function.shape) + " on [0, " + text(range) + "] as " + text(accuracy) +
                       " of its largest value; raise Options::tolerance, or take Method::direct");
}

}  // namespace rbf::detail
