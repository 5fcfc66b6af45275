// Kernels as numbers, names of methods, and what was chosen as one line.
#include <algorithm>
#include <cmath>
#include <ostream>

#include "rbf/catalogue.hpp"
#include "rbf/check.hpp"
#include "rbf/rbf.hpp"

namespace rbf {
namespace {

detail::Profile profile_at(const Function& function, double r, const char* name) {
  detail::check_function(function);
  if (!(r >= 0) || !std::isfinite(r))
    throw InvalidArgument("rbf: " + std::string(name) + " = " + detail::text(r) + ", must be at least 0 and finite");
  const long double exact = r;
  return detail::entry_of(function.kernel).profile(exact * exact, function.shape);
}

struct Named {
  Method method;
  const char* name;  // as in files
  const char* meaning;
};

constexpr Named method_names[] = {
    {Method::automatic, "auto", "the method with the smaller predicted time"},
    {Method::direct, "direct", "sums every pair of a centre and a target"},
    {Method::gaussians, "gaussians",
     "replaces the kernel by few Gaussians and a polynomial; each Gaussian is a fast Gauss transform"}};

const Named& named(Method method) {
  for (const Named& known : method_names)
    if (known.method == method) return known;
  return method_names[0];
}

}  // namespace

double value(const Function& function, double r) { return static_cast<double>(profile_at(function, r, "r").value); }

double derivative(const Function& function, double r) {
  const detail::Profile at = profile_at(function, r, "r");
  return r > 0 ? static_cast<double>(detail::first_derivative(at, r)) : 0;
}

double largest_value(const Function& function, double range) {
  profile_at(function, range, "range");
  return detail::largest(function, range, 0).of[0];
}

double largest_derivative(const Function& function, double range, int order) {
  profile_at(function, range, "range");
  if (order < 0 || order > highest_derivative(function.kernel))
    throw InvalidArgument("rbf: order = " + std::to_string(order) + ", must lie in 0 .. " +
                          std::to_string(highest_derivative(function.kernel)) + " for " + to_string(function.kernel));
  return detail::largest(function, range, order).of[order];
}

namespace detail {

/// All kernels are monotone but r^2 ln r, whose turning point is exp(-1/2). Derivatives are looked for at samples: the
/// largest of them is at most 1e-3 below the true one, which makes the promise stricter.
Scales largest(const Function& function, double range, int order) {
  const KernelEntry& entry = entry_of(function.kernel);
  Scales scales;
  const auto look_at = [&](long double r) {
    const Profile at = entry.profile(r * r, function.shape);
    const auto larger = [&](int j, long double x) {
      scales.of[j] = std::max(scales.of[j], static_cast<double>(std::abs(x)));
    };
    larger(0, at.value);
    if (order >= 1 && r > 0) larger(1, first_derivative(at, r));
    if (order >= 2) larger(2, 2 * at.slope);
    if (order >= 2) larger(2, second_derivative(at, r * r));
  };
  const long double turning = std::exp(-0.5L);
  look_at(0);
  look_at(range);
  if (turning < range) look_at(turning);
  if (order == 0) return scales;
  constexpr int a_decade = 50, decades = 16;
  for (int i = 1; i < a_decade * decades; ++i)
    look_at(range * std::pow(10.0L, -static_cast<long double>(i) / a_decade));
  return scales;
}

}  // namespace detail

const std::vector<Method>& methods() {
  static const std::vector<Method> all = [] {
    std::vector<Method> list;
    for (const Named& known : method_names) list.push_back(known.method);
    return list;
  }();
  return all;
}

std::string to_string(Method method) { return named(method).name; }
std::string meaning(Method method) { return named(method).meaning; }

std::ostream& operator<<(std::ostream& out, const Choice& choice) {
  out << to_string(choice.function.kernel);
  if (takes_shape(choice.function.kernel)) out << " of shape " << choice.function.shape;
  out << " by " << to_string(choice.method) << ": " << choice.centres << " centres, " << choice.targets
      << " targets, tolerance " << choice.tolerance << " on [0, " << choice.range << "]";
  if (choice.method == Method::gaussians) {
    out << ", " << choice.terms.size() << (choice.terms.size() == 1 ? " Gaussian" : " Gaussians");
    out << " in " << choice.transforms << (choice.transforms == 1 ? " transform" : " transforms");
    if (choice.near > 0) out << " beyond " << choice.near;
    out << ", error of the kernel " << choice.kernel_error << ", bound " << choice.bound;
  }
  return out << ", about " << choice.seconds << " s";
}

}  // namespace rbf
