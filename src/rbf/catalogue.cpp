#include "rbf/catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rbf {
namespace detail {
namespace {

constexpr double pi = std::numbers::pi;

/// exp(-t c^2) t^power / factor: what the kernels in r^2 + c^2 have.
double shaped_density(double t, double c, double power, double factor) {
  return std::exp(-t * c * c) * std::pow(t, power) / factor;
}

/// With a = k r: exp(-a) is the integral of (k / (2 sqrt(pi))) t^(-3/2) exp(-k^2/(4t)) exp(-t r^2). Matern's kernels are
/// Student's densities in Fourier space: rho ~ t^(-power) exp(-k^2/(4t)).
double matern_density(double t, double k, double power) {
  const double q = k * k / 4;  // integral_0^inf t^(-power) exp(-q/t) dt = q^(1-power) Gamma(power-1)
  return std::exp(-q / t) * std::pow(t, -power) * std::pow(q, power - 1) / std::tgamma(power - 1);
}

std::vector<KernelEntry> all_kernels() {
  std::vector<KernelEntry> all;
  all.push_back({.kernel = Kernel::gaussian,
                 .name = "gaussian",
                 .formula = "exp(-r^2 / c^2)",
                 .profile = [](long double s, long double c) {
                   const long double t = 1 / (c * c), f = std::exp(-t * s);
                   return Profile{f, -t * f, t * t * f, -t * t * t * f};
                 }});
  all.push_back({.kernel = Kernel::multiquadric,
                 .name = "multiquadric",
                 .formula = "sqrt(r^2 + c^2)",
                 .positive_order = 1,
                 .profile =
                     [](long double s, long double c) {
                       const long double q = s + c * c, f = std::sqrt(q);
                       return Profile{f, 1 / (2 * f), -1 / (4 * f * q), 3 / (8 * f * q * q)};
                     },
                 .density = [](double t, double c) { return shaped_density(t, c, -1.5, 2 * std::sqrt(pi)); }});
  all.push_back({.kernel = Kernel::inverse_multiquadric,
                 .name = "inverse-multiquadric",
                 .formula = "1 / sqrt(r^2 + c^2)",
                 .profile =
                     [](long double s, long double c) {
                       const long double q = s + c * c, f = 1 / std::sqrt(q);
                       return Profile{f, -f / (2 * q), 3 * f / (4 * q * q), -15 * f / (8 * q * q * q)};
                     },
                 .density = [](double t, double c) { return shaped_density(t, c, -0.5, std::sqrt(pi)); }});
  all.push_back({.kernel = Kernel::inverse_quadratic,
                 .name = "inverse-quadratic",
                 .formula = "1 / (r^2 + c^2)",
                 .profile =
                     [](long double s, long double c) {
                       const long double f = 1 / (s + c * c);
                       return Profile{f, -f * f, 2 * f * f * f, -6 * f * f * f * f};
                     },
                 .density = [](double t, double c) { return shaped_density(t, c, 0, 1); }});
  all.push_back({.kernel = Kernel::thin_plate,
                 .name = "thin-plate",
                 .formula = "r^2 ln r",
                 .takes_shape = false,
                 .positive_order = 2,
                 .highest_derivative = 1,
                 .continuous_derivatives = 1,
                 .profile =
                     [](long double s, long double) {
                       if (!(s > 0)) return Profile{};
                       const long double l = std::log(s);
                       return Profile{s * l / 2, (l + 1) / 2, 1 / (2 * s), -1 / (2 * s * s)};
                     },
                 .density = [](double t, double) { return 1 / (2 * t * t); }});
  all.push_back({.kernel = Kernel::matern32,
                 .name = "matern32",
                 .formula = "(1 + a) exp(-a), a = sqrt(3) r / c",
                 .continuous_derivatives = 2,
                 .profile =
                     [](long double s, long double c) {
                       const long double a = std::sqrt(3 * s) / c, e = std::exp(-a), q = 3 / (2 * c * c);
                       if (!(s > 0)) return Profile{1, -q};
                       return Profile{(1 + a) * e, -q * e, q * q * e / a, -q * q * q * e * (1 + a) / (a * a * a)};
                     },
                 .density = [](double t, double c) { return matern_density(t, std::sqrt(3.0) / c, 2.5); }});
  all.push_back({.kernel = Kernel::matern52,
                 .name = "matern52",
                 .formula = "(1 + a + a^2/3) exp(-a), a = sqrt(5) r / c",
                 .continuous_derivatives = 4,
                 .profile =
                     [](long double s, long double c) {
                       const long double a = std::sqrt(5 * s) / c, e = std::exp(-a), q = 5 / (6 * c * c);
                       return Profile{(1 + a + a * a / 3) * e, -q * (1 + a) * e, 3 * q * q * e,
                                      s > 0 ? -9 * q * q * q * e / a : 0};
                     },
                 .density = [](double t, double c) { return matern_density(t, std::sqrt(5.0) / c, 3.5); }});
  return all;
}

}  // namespace

const std::vector<KernelEntry>& catalogue() {
  static const std::vector<KernelEntry> all = all_kernels();
  return all;
}

const KernelEntry& entry_of(Kernel kernel) {
  for (const KernelEntry& entry : catalogue())
    if (entry.kernel == kernel) return entry;
  throw InvalidArgument("rbf: kernel = " + std::to_string(static_cast<int>(kernel)) +
                        " is no kernel; rbf::kernels() lists them");
}

}  // namespace detail

const std::vector<Kernel>& kernels() {
  static const std::vector<Kernel> all = [] {
    std::vector<Kernel> list;
    for (const detail::KernelEntry& entry : detail::catalogue()) list.push_back(entry.kernel);
    return list;
  }();
  return all;
}

std::string to_string(Kernel kernel) { return detail::entry_of(kernel).name; }

std::optional<Kernel> kernel_named(const std::string& name) {
  for (const detail::KernelEntry& entry : detail::catalogue())
    if (name == entry.name) return entry.kernel;
  return {};
}

std::string formula(Kernel kernel) { return detail::entry_of(kernel).formula; }
bool takes_shape(Kernel kernel) { return detail::entry_of(kernel).takes_shape; }
int positive_order(Kernel kernel) { return detail::entry_of(kernel).positive_order; }
int continuous_derivatives(Kernel kernel) { return detail::entry_of(kernel).continuous_derivatives; }
int highest_derivative(Kernel kernel) { return detail::entry_of(kernel).highest_derivative; }

}  // namespace rbf
