#include "rbf/fit/box_integrals.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "rbf/expansion/expansion.hpp"

namespace rbf::detail {
namespace {

/// The integral of exp(-t x^2) from p to q.
double gaussian_between(double t, double p, double q) {
  const double root = std::sqrt(t), half = std::sqrt(std::numbers::pi) / (2 * root);
  if (p > 0) return half * (std::erfc(root * p) - std::erfc(root * q));
  if (q < 0) return half * (std::erfc(-root * q) - std::erfc(-root * p));
  return half * (std::erf(root * q) - std::erf(root * p));
}

/// The expansion to the smallest error that there is.
Expansion accurate_expansion(const Function& function, double range) {
  for (const double accuracy : {1e-11, 1e-10, 1e-9, 1e-8, 1e-7}) {
    try {
      return expand(function, range, 0, 0, accuracy, Exponents::even);
    } catch (const ToleranceError&) {  // a larger one may do
    }
  }
  return expand(function, range, 0, 0, 1e-6, Exponents::even);
}

}  // namespace

template <int d>
double Box<d>::range(const Points<d>& points) const {
  double squared = 0;
  for (Eigen::Index j = 0; j < points.cols(); ++j)
    squared =
        std::max(squared, (points.col(j) - low).cwiseAbs().cwiseMax((points.col(j) - high).cwiseAbs()).squaredNorm());
  return std::sqrt(squared);
}

template <int d>
BoxIntegrals box_integrals(const Function& function, const Points<d>& centres, const Box<d>& box, int threads) {
  const Expansion sum = accurate_expansion(function, box.range(centres));
  BoxIntegrals found{Eigen::VectorXd(centres.cols()), sum.error * sum.scales.of[0] * box.volume()};
  constexpr std::size_t piece = 256;
  const std::size_t count = static_cast<std::size_t>(centres.cols());
  gaussdrift::base::parallel_for(
      {(count + piece - 1) / piece, 1e-7 * static_cast<double>(count * sum.terms.size())}, threads, [&](std::size_t i) {
        for (std::size_t j = i * piece; j < std::min(count, (i + 1) * piece); ++j) {
          const Eigen::Array<double, d, 1> p = box.low - centres.col(static_cast<Eigen::Index>(j)),
                                           q = box.high - centres.col(static_cast<Eigen::Index>(j));
          // Means of 1, x^2 and x^4 along each axis, and from them of r^2 and r^4.
          const Eigen::Array<double, d, 1> second = (p * p + p * q + q * q) / 3,
                                           fourth =
                                               (p.pow(4) + p.pow(3) * q + p * p * q * q + p * q.pow(3) + q.pow(4)) / 5;
          const double square = second.sum(), both = fourth.sum() + square * square - second.square().sum();
          double value = box.volume() * (sum.polynomial[0] + sum.polynomial[1] * square + sum.polynomial[2] * both);
          for (const WeightedGaussian& term : sum.terms) {
            double product = term.weight;
            for (int l = 0; l < d; ++l) product *= gaussian_between(term.exponent, p[l], q[l]);
            value += product;
          }
          found.values[static_cast<Eigen::Index>(j)] = value;
        }
      });
  return found;
}

template struct Box<1>;
template struct Box<2>;
template struct Box<3>;
template BoxIntegrals box_integrals<1>(const Function&, const Points<1>&, const Box<1>&, int);
template BoxIntegrals box_integrals<2>(const Function&, const Points<2>&, const Box<2>&, int);
template BoxIntegrals box_integrals<3>(const Function&, const Points<3>&, const Box<3>&, int);

}  // namespace rbf::detail
