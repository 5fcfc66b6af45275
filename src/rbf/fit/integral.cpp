#include "rbf/integral.hpp"

#include <Eigen/Cholesky>
#include <cmath>

#include "rbf/check.hpp"
#include "rbf/fit/box_integrals.hpp"
#include "rbf/fit/frame.hpp"
#include "rbf/fit/kernel_matrix.hpp"

namespace rbf {
namespace {

template <int d>
detail::Box<d> checked_box(const Eigen::Matrix<double, d, 1>& low, const Eigen::Matrix<double, d, 1>& high) {
  for (int l = 0; l < d; ++l)
    if (!std::isfinite(low[l]) || !std::isfinite(high[l]) || low[l] > high[l])
      throw InvalidArgument("rbf: the box reaches from " + detail::text(low[l]) + " to " + detail::text(high[l]) +
                            " along axis " + std::to_string(l) + "; both must be finite, and the first not above");
  return {low, high};
}

/// Integrals of the polynomials of a frame: linear, so they are the values in the middle times the volume.
template <int d>
Eigen::RowVectorXd polynomial_integrals(const detail::Frame<d>& frame, const detail::Box<d>& box) {
  const Points<d> middle = box.low + (box.high - box.low) / 2;
  return box.volume() * frame.values(middle);
}

}  // namespace

template <int d>
Integral integral(const Interpolant<d>& interpolant, const Eigen::Matrix<double, d, 1>& low,
                  const Eigen::Matrix<double, d, 1>& high) {
  const detail::Box<d> box = checked_box<d>(low, high);
  const Function& function = interpolant.report().function;
  const detail::BoxIntegrals of = detail::box_integrals<d>(function, interpolant.points(), box, 0);
  const detail::Frame<d> frame(interpolant.points(), positive_order(function.kernel));
  return {interpolant.weights().transpose() * of.values +
              interpolant.polynomial().transpose() * polynomial_integrals<d>(frame, box).transpose(),
          of.error * interpolant.weights().cwiseAbs().colwise().sum().transpose()};
}

// The quadrature is the integral applied to (A + ridge) lambda + P b = f, P^T lambda = 0, which is symmetric: w solves
// (A + ridge) w + P b = integrals of phi, P^T w = integrals of the polynomials. A part of w that has these moments is
// brought to the right-hand side; the rest are the weights of an interpolant.
template <int d>
Eigen::VectorXd quadrature_weights(const Function& function, const Eigen::Ref<const Points<d>>& nodes,
                                   const Eigen::Matrix<double, d, 1>& low, const Eigen::Matrix<double, d, 1>& high,
                                   const FitOptions& options) {
  detail::check_function(function);
  const detail::Box<d> box = checked_box<d>(low, high);
  const Points<d> packed = nodes;
  detail::check_points("point", packed.data(), d, static_cast<std::size_t>(packed.cols()), d, options.threads);
  if (packed.cols() == 0) throw InvalidArgument("rbf: there are no nodes");
  const detail::Frame<d> frame(packed, positive_order(function.kernel));
  Eigen::VectorXd wanted = detail::box_integrals<d>(function, packed, box, options.threads).values;
  Eigen::VectorXd moments = Eigen::VectorXd::Zero(packed.cols());
  if (frame.size() > 0) {
    const Eigen::MatrixXd polynomials = frame.values(packed);
    moments = polynomials *
              (polynomials.transpose() * polynomials).ldlt().solve(polynomial_integrals<d>(frame, box).transpose());
    const Plan<d> sum(
        function, packed, moments,
        {.tolerance = smallest_tolerance, .threads = options.threads, .memory_limit = options.memory_limit});
    wanted -= sum.evaluate(packed).col(0) + detail::sign_of(function.kernel) * options.regularisation * moments;
  }
  return Interpolant<d>(function, packed, wanted, options).weights().col(0) + moments;
}

template Integral integral<1>(const Interpolant<1>&, const Eigen::Matrix<double, 1, 1>&,
                              const Eigen::Matrix<double, 1, 1>&);
template Integral integral<2>(const Interpolant<2>&, const Eigen::Vector2d&, const Eigen::Vector2d&);
template Integral integral<3>(const Interpolant<3>&, const Eigen::Vector3d&, const Eigen::Vector3d&);
template Eigen::VectorXd quadrature_weights<1>(const Function&, const Eigen::Ref<const Points<1>>&,
                                               const Eigen::Matrix<double, 1, 1>&, const Eigen::Matrix<double, 1, 1>&,
                                               const FitOptions&);
template Eigen::VectorXd quadrature_weights<2>(const Function&, const Eigen::Ref<const Points<2>>&,
                                               const Eigen::Vector2d&, const Eigen::Vector2d&, const FitOptions&);
template Eigen::VectorXd quadrature_weights<3>(const Function&, const Eigen::Ref<const Points<3>>&,
                                               const Eigen::Vector3d&, const Eigen::Vector3d&, const FitOptions&);

}  // namespace rbf
