// The kernels: one object each, with all that the library knows of it. A kernel is a function of s = r^2,
// phi(r) = f(r^2), and an integral over Gaussians (Bernstein's theorem),
//
//     f(s) = polynomial in s + integral_0^inf rho(t) (exp(-t s) - its Taylor polynomial of degree < m) dt
//
// with m its order of conditional positive definiteness and rho of one sign.
#pragma once

#include <limits>
#include <vector>

#include "rbf/rbf.hpp"

namespace rbf::detail {

/// f, f', f'' and f''' at one s > 0. At s = 0 f and what is finite of the others.
struct Profile {
  long double value = 0, slope = 0, curvature = 0, third = 0;
};

struct KernelEntry {
  Kernel kernel{};
  const char* name = "";     // as in files
  const char* formula = "";  // in r, c and a
  bool takes_shape = true;
  int positive_order = 0;  // m
  int highest_derivative = 2;
  int continuous_derivatives = std::numeric_limits<int>::max();
  Profile (*profile)(long double s, long double shape) = nullptr;
  double (*density)(double t, double shape) = nullptr;  // |rho(t)|; none for the Gaussian, whose rho is a point
};

const std::vector<KernelEntry>& catalogue();
const KernelEntry& entry_of(Kernel kernel);

/// phi'(r) and phi''(r) of a profile at r > 0 or 0.
inline long double first_derivative(const Profile& at, long double r) { return 2 * r * at.slope; }
inline long double second_derivative(const Profile& at, long double s) { return 2 * at.slope + 4 * s * at.curvature; }

/// What errors are relative to: the largest |phi|, |phi'|, and |phi''| or |phi'/r|, 0 <= r <= range, up to `order`.
struct Scales {
  double of[3] = {0, 0, 0};
};
Scales largest(const Function& function, double range, int order);

}  // namespace rbf::detail
