#include "accuracy/causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/longest_side.hpp"
#include "particle/subset.hpp"
#include "sim/borders/outside.hpp"
#include "sim/work.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr double few = 2.5e6;  // work of a tenth of a second

double sum_of_weights(const Particles& particles) {
  double sum = 0;
  for (const double alpha : particles.alpha) sum += std::abs(alpha);
  return sum;
}

/// Of the fitted velocity, where the density is: near the particles that carry much.
double error_of_velocity(const Scene& scene, const Particles& particles) {
  constexpr double much = 0.1;
  double largest = 0;
  for (const double alpha : particles.alpha) largest = std::max(largest, std::abs(alpha));
  std::vector<std::size_t> heavy;
  for (std::size_t j = 0; j < particles.size(); ++j)
    if (std::abs(particles.alpha[j]) >= much * largest) heavy.push_back(j);
  const Particles some = subset(particles, heavy);
  return scene.velocity->fit_error(some.view());
}

/// The largest |grad rho| between neighbours.
double steepest_slope(const Lattice& lattice, const std::vector<double>& rho) {
  double steepest = 0;
  for (std::size_t i = 0; i < rho.size(); ++i) {
    double squares = 0;
    std::size_t stride = 1, rest = i;
    for (std::size_t k = 0; k < static_cast<std::size_t>(lattice.dimension); ++k) {
      const std::size_t points = lattice.points[k];
      if (rest % points + 1 < points) {
        const double slope = (rho[i + stride] - rho[i]) / lattice.spacing;
        squares += slope * slope;
      }
      rest /= points;
      stride *= points;
    }
    steepest = std::max(steepest, squares);
  }
  return std::sqrt(steepest);
}

}  // namespace

bool is_fitted(const Scene& scene) { return scene.density->fit_error() > 0 || scene.velocity->is_fitted(); }

double fit_of_samples(const Scene& scene, const Particles& start, const Particles& carried,
                      const std::vector<double>& rho, double time, double norm) {
  double largest = 0;  // rho_0
  for (const double alpha : start.alpha) largest = std::max(largest, std::abs(alpha));
  largest /= scene.seeding.largest_cell();
  double error = 0;
  if (const double of_density = scene.density->fit_error(); of_density > 0 && largest > 0)
    error += of_density / largest;
  if (scene.velocity->is_fitted())
    error += time * std::max(error_of_velocity(scene, start), error_of_velocity(scene, carried)) *
             steepest_slope(scene.evaluation, rho) / norm;
  return error;
}

bool is_told(const Budget& budget, const Cause& cause) {
  const auto is = [&](std::initializer_list<double Budget::*> some) {
    return std::find(some.begin(), some.end(), cause.error) != some.end();
  };
  if (is({&Budget::time_stepping, &Budget::smoothing, &Budget::quadrature, &Budget::left_out}))
    return !budget.only_some;
  if (is({&Budget::noise})) return budget.only_some;
  return !is({&Budget::fit, &Budget::others}) || budget.*cause.error > 0;
}

void find_dominating(Budget& budget) {
  budget.dominates = std::max_element(causes.begin(), causes.end(), [&](const Cause& a, const Cause& b) {
                       return budget.*a.error < budget.*b.error;
                     })->name;
}

std::string nothing_to_explain(const Particles& last, double outside, double time) {
  const double weight = sum_of_weights(last);
  if (weight > 0 && !is_all(outside)) return "";
  return fmt::format("at t = {:.4g} {}", time, why_nothing_is_left(outside, weight));
}

double bound_of_left_out(const Scene& scene, const SeedReport& report, const Particles& start, const Particles& carried,
                         double norm) {
  if (report.left_out == 0) return 0;
  double growth = 1;
  for (std::size_t j = 0; scene.decay_rate && j < carried.size(); ++j)
    if (start.alpha[j] != 0) growth = std::max(growth, std::abs(carried.alpha[j] / start.alpha[j]));
  return growth * density_left_out(scene, report) / norm;
}

bool is_enclosed(const Domain& domain) {
  bool enclosed = true;
  for (std::size_t k = 0; k < static_cast<std::size_t>(domain.dimension); ++k)
    for (const Edge edge : domain.edges[k]) enclosed = enclosed && (edge == Edge::periodic || edge == Edge::closed);
  return enclosed;
}

double extent(const Case& spec) { return longest_side(spec.domain.dimension, spec.domain.min, spec.domain.max); }

double work_allowed(const Case& spec, const Scene& scene, std::size_t particles, double share) {
  return std::max(few, share * work_of(spec, scene, particles).total());
}

Budget checked(Budget budget) {
  for (const double error : {budget.time_stepping, budget.smoothing, budget.quadrature, budget.total})
    if (budget.known() && !std::isfinite(error))
      budget.not_covered = "density or velocity are not finite somewhere between the lattice points";
  return budget;
}

}  // namespace gaussdrift::accuracy
