// The kernels as functions of s = r^2 in packs. For the sources that may include pack.hpp.
#pragma once

#include "core/simd/functions.hpp"
#include "rbf/kernels/kernels.hpp"

namespace rbf::detail::CORE_ISA {
namespace {

using namespace gaussdrift::core::CORE_ISA;

constexpr double tiny = 1e-290;  // squares below count as 0: r^2 ln r is 1e-287 there

/// f(s), f'(s), f''(s) with phi(r) = f(r^2), up to an order. Where f' or f'' is infinite at s = 0, finite numbers stand
/// there: the distances that they are multiplied with are 0.
struct Profile {
  Pack value, slope, curvature;
};

/// The shape as the formulas need it.
struct Shape {
  double squared, inverse_squared, rate, factor;
};

template <Kernel kernel>
CORE_INLINE Shape shape_of(double c) {
  const double squared = c * c;
  if constexpr (kernel == Kernel::matern32) return {squared, 0, __builtin_sqrt(3.0) / c, 3 / (2 * squared)};
  if constexpr (kernel == Kernel::matern52) return {squared, 0, __builtin_sqrt(5.0) / c, 5 / (6 * squared)};
  return {squared, 1 / squared, 0, 0};
}

template <Kernel kernel, int order>
CORE_INLINE Profile profile(Pack s, const Shape& shape) {
  Profile f{};
  if constexpr (kernel == Kernel::gaussian) {
    f.value = exp_interpolated(s * -shape.inverse_squared);
    if constexpr (order >= 1) f.slope = f.value * -shape.inverse_squared;
    if constexpr (order >= 2) f.curvature = f.slope * -shape.inverse_squared;
  } else if constexpr (kernel == Kernel::multiquadric) {
    const Pack q = s + shape.squared;
    f.value = root(q);
    if constexpr (order >= 1) f.slope = 0.5 / f.value;
    if constexpr (order >= 2) f.curvature = f.slope * -0.5 / q;
  } else if constexpr (kernel == Kernel::inverse_multiquadric) {
    const Pack q = s + shape.squared;
    f.value = divided_rsqrt(q);
    if constexpr (order >= 1) f.slope = f.value * -0.5 / q;
    if constexpr (order >= 2) f.curvature = f.slope * -1.5 / q;
  } else if constexpr (kernel == Kernel::inverse_quadratic) {
    f.value = 1.0 / (s + shape.squared);
    if constexpr (order >= 1) f.slope = -f.value * f.value;
    if constexpr (order >= 2) f.curvature = f.slope * f.value * -2.0;
  } else if constexpr (kernel == Kernel::thin_plate) {
    const Pack half_log = select(reinterpret_cast<Bits>(s > tiny), log_positive(s) * 0.5);
    f.value = s * half_log;
    if constexpr (order >= 1) f.slope = half_log + 0.5;
  } else {
    const Pack a = root(s) * shape.rate, e = exp_interpolated(-a);
    if constexpr (kernel == Kernel::matern32) {
      f.value = e * a + e;
      if constexpr (order >= 1) f.slope = e * -shape.factor;
      if constexpr (order >= 2)
        f.curvature = select(reinterpret_cast<Bits>(s > tiny), e * (shape.factor * shape.factor) / a);
    } else {
      f.value = e * (a * (a * (1.0 / 3) + 1.0) + 1.0);
      if constexpr (order >= 1) f.slope = (e * a + e) * -shape.factor;
      if constexpr (order >= 2) f.curvature = e * (3 * shape.factor * shape.factor);
    }
  }
  return f;
}

/// work.operator()<d, kernel, order>() for those of a job.
template <Kernel kernel, class Job, class Work>
CORE_INLINE void in_order_and_dimension(const Job& job, const Work& work) {
  const auto in_dimension = [&]<int order>() {
    if (job.dimension == 1) work.template operator()<1, kernel, order>();
    if (job.dimension == 2) work.template operator()<2, kernel, order>();
    if (job.dimension == 3) work.template operator()<3, kernel, order>();
  };
  if (job.order == 0) in_dimension.template operator()<0>();
  if (job.order == 1) in_dimension.template operator()<1>();
  if constexpr (kernel != Kernel::thin_plate)
    if (job.order == 2) in_dimension.template operator()<2>();
}

template <class Job, class Work>
CORE_INLINE void in_instance(const Job& job, const Work& work) {
  switch (job.kernel) {
    case Kernel::gaussian:
      return in_order_and_dimension<Kernel::gaussian>(job, work);
    case Kernel::multiquadric:
      return in_order_and_dimension<Kernel::multiquadric>(job, work);
    case Kernel::inverse_multiquadric:
      return in_order_and_dimension<Kernel::inverse_multiquadric>(job, work);
    case Kernel::inverse_quadratic:
      return in_order_and_dimension<Kernel::inverse_quadratic>(job, work);
    case Kernel::thin_plate:
      return in_order_and_dimension<Kernel::thin_plate>(job, work);
    case Kernel::matern32:
      return in_order_and_dimension<Kernel::matern32>(job, work);
    case Kernel::matern52:
      return in_order_and_dimension<Kernel::matern52>(job, work);
  }
}

}  // namespace
}  // namespace rbf::detail::CORE_ISA
