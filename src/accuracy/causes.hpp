// The causes of an error one by one, and what predicting and measuring them have in common.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "accuracy/budget.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/error.hpp"
#include "sim/scene.hpp"

namespace gaussdrift::accuracy {

struct Cause {
  const char* name;  // for people, and of Budget::dominates
  const char* key;   // in JSON
  double Budget::*error;
};
constexpr const char* name_of_noise = "noise of the walk";
constexpr std::array<Cause, 8> causes{{{"time stepping", "time_stepping", &Budget::time_stepping},
                                       {"smoothing", "smoothing", &Budget::smoothing},
                                       {"quadrature", "quadrature", &Budget::quadrature},
                                       {"Gauss transform", "transform", &Budget::transform},
                                       {"particles left out", "left_out", &Budget::left_out},
                                       {"fit of samples", "fit", &Budget::fit},
                                       {name_of_noise, "noise", &Budget::noise},
                                       {"other causes", "others", &Budget::others}}};

/// Is it a cause of errors of this case?
bool is_told(const Budget& budget, const Cause& cause);

/// Sets Budget::dominates to the name of the largest.
void find_dominating(Budget& budget);

constexpr double rounding = 1e-14;  // no cause is said to be smaller

/// At least `rounding`; NaN stays NaN.
inline double at_least_rounding(double error) { return error < rounding ? rounding : error; }

constexpr const char* lost_paths = "the paths of some particles could not be followed";
constexpr const char* no_exact_density = "the exact density is not known, or 0, at the last output";

/// Why nothing can be explained at the last output; empty: it can. Without mass on the grid there is no error to
/// explain, and no setting changes one.
std::string nothing_to_explain(const Particles& last, double outside, double time);

/// What was left out of the lattice, at most, relative to the norm; where weights grow, by as much as the largest of
/// those carried did.
double bound_of_left_out(const Scene& scene, const SeedReport& report, const Particles& start, const Particles& carried,
                         double norm);

/// Are density or velocity fitted to samples?
bool is_fitted(const Scene& scene);

/// What the errors of fits do to a density, estimated: that of rho_0 is carried along, as a part of the largest rho_0.
/// That of the velocity near the particles moves it, all the time, along its steepest slope.
/// start, carried: particles at t = 0 and at `time`;  rho: on the evaluation lattice at `time`;  norm: largest there
double fit_of_samples(const Scene& scene, const Particles& start, const Particles& carried,
                      const std::vector<double>& rho, double time, double norm);

/// True if every end of the domain is periodic or closed: what a shape has beyond them is no part of the scene.
bool is_enclosed(const Domain& domain);

/// The longest side of the domain.
double extent(const Case& spec);

/// The work that may be spent on telling the errors of a run apart: a share of that of the run, or a tenth of a second.
double work_allowed(const Case& spec, const Scene& scene, std::size_t particles, double share);

/// A budget with a number that could not be computed says so instead.
Budget checked(Budget budget);

/// The budget, or why there is none. A failure here is not one of the run, and must not cost its results.
template <class Compute>
Budget covered_or_why(const Compute& compute) {
  try {
    return checked(compute());
  } catch (const NumericalError& error) {
    Budget budget;
    budget.not_covered = error.what();
    return budget;
  }
}

}  // namespace gaussdrift::accuracy
