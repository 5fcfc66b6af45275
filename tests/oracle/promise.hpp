// The promise as a measurement: terms are told apart by one-hot columns of weights, each compared with the definition
// in long double.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <string>

#include "oracle/naive.hpp"

namespace naive {

/// Sources of which some are watched, each by a column of weights of its own; the others weigh nothing but take part in
/// the choice of parameters and fill the boxes.
template <int d>
struct Scene {
  std::string name;
  double sigma = 1;
  fgtd::Points<d> sources;
  std::vector<Eigen::Index> watched;
  fgtd::Points<d> targets;
  fgtd::TensorGrid grid;

  Eigen::MatrixXd weights() const {
    Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(sources.cols(), static_cast<Eigen::Index>(watched.size()));
    for (std::size_t k = 0; k < watched.size(); ++k) columns(watched[k], static_cast<Eigen::Index>(k)) = 1;
    return columns;
  }
  /// Watches `count` sources, spread over the list, the first and the last among them.
  void watch(int count) {
    watched.clear();
    const Eigen::Index last = sources.cols() - 1;
    for (int k = 0; k < count; ++k) watched.push_back(count > 1 ? k * last / (count - 1) : 0);
    watched.erase(std::unique(watched.begin(), watched.end()), watched.end());
  }
};

/// sigma |y - x|^2, in long double where a double would overflow or vanish.
template <int d>
long double squared_distance(const Eigen::Matrix<double, d, 1>& y, const Eigen::Matrix<double, d, 1>& x, double sigma) {
  long double squared = 0;
  for (int l = 0; l < d; ++l) {
    const long double apart = static_cast<long double>(y[l]) - x[l];
    squared += apart * apart;
  }
  return sigma * squared;
}

/// The exact terms at given points for every alpha once asked for: [points][watched].
template <int d>
class ExactTerms {
 public:
  ExactTerms(const Scene<d>& scene, const fgtd::Points<d>& points) : scene_(scene), points_(points) {
    squared_.resize(points.cols(), static_cast<Eigen::Index>(scene.watched.size()));
    for (Eigen::Index k = 0; k < squared_.cols(); ++k)
      for (Eigen::Index i = 0; i < points.cols(); ++i)
        squared_(i, k) = static_cast<double>(
            std::min<long double>(1e300L, squared_distance<d>(points.col(i), source(k), scene.sigma)));
  }

  /// sigma |y_i - x_k|^2
  double squared(Eigen::Index i, Eigen::Index k) const { return squared_(i, k); }

  const Eigen::MatrixXd& values(const fgtd::Derivative<d>& alpha) {
    const auto [place, fresh] = values_.try_emplace(alpha);
    if (fresh) {
      place->second = Eigen::MatrixXd::Zero(squared_.rows(), squared_.cols());
      for (Eigen::Index k = 0; k < squared_.cols(); ++k)
        for (Eigen::Index i = 0; i < squared_.rows(); ++i)
          if (squared_(i, k) < 1e4)  // beyond, every term is 0
            place->second(i, k) = static_cast<double>(term<d>(points_.col(i), source(k), scene_.sigma, alpha));
    }
    return place->second;
  }

 private:
  Eigen::Matrix<double, d, 1> source(Eigen::Index k) const {
    return scene_.sources.col(scene_.watched[static_cast<std::size_t>(k)]);
  }

  const Scene<d>& scene_;
  const fgtd::Points<d>& points_;
  Eigen::MatrixXd squared_;
  std::map<fgtd::Derivative<d>, Eigen::MatrixXd> values_;
};

struct Errors {
  double of_promise = 0;  // largest error over what is promised, rounding included: at most 1
  double of_scale = 0;    // largest error over N_alpha
  std::string where;      // of the first

  void add(const Errors& other) {
    of_scale = std::max(of_scale, other.of_scale);
    if (other.of_promise <= of_promise) return;
    of_promise = other.of_promise;
    where = other.where;
  }
};

/// What fgtd promises for one term of scale N_alpha at sigma r^2 = squared. `rounding`: 3e-14 N_alpha, which fades too;
/// far away relative to the term.
inline double promised(double tolerance, double scale, double squared, double exact, double rounding = 3e-14) {
  const long double limit = 2 * std::log(1 / tolerance) + 40;  // long: a large scale outlasts what a double fades to
  const long double fading = std::exp(std::min(0.0L, limit - squared));
  return static_cast<double>((tolerance + rounding) * scale * fading) + 1e-12 * std::abs(exact) + 1e-300;
}

/// values [points][watched], a block of the result of a Plan with Scene::weights().
template <int d>
Errors measure(ExactTerms<d>& exact, const Eigen::Ref<const Eigen::MatrixXd>& values, double sigma, double tolerance,
               const fgtd::Derivative<d>& alpha) {
  const Eigen::MatrixXd& right = exact.values(alpha);
  const double scale = fgtd::derivative_scale<d>(alpha, sigma);
  Errors errors;
  for (Eigen::Index k = 0; k < right.cols(); ++k)
    for (Eigen::Index i = 0; i < right.rows(); ++i) {
      const double error = std::abs(values(i, k) - right(i, k));
      if (error == 0) continue;
      double share = error / promised(tolerance, scale, exact.squared(i, k), right(i, k));
      if (!(share >= 0)) share = 1e300;  // a NaN
      if (error / scale > errors.of_scale) errors.of_scale = error / scale;
      if (share > errors.of_promise) {
        errors.of_promise = share;
        errors.where = "column " + std::to_string(k) + ", point " + std::to_string(i) +
                       ", sigma r^2 = " + std::to_string(exact.squared(i, k)) + ", value " +
                       std::to_string(values(i, k)) + " for " + std::to_string(right(i, k));
      }
    }
  return errors;
}

/// "(0, 1, 2)"
template <int d>
std::string name_of(const fgtd::Derivative<d>& alpha) {
  std::string name;
  for (const int a : alpha) name += (name.empty() ? "(" : ", ") + std::to_string(a);
  return name + ")";
}

/// Names a test by the method that is its parameter.
struct MethodName {
  std::string operator()(const testing::TestParamInfo<fgtd::Method>& of) const { return fgtd::to_string(of.param); }
};

}  // namespace naive
