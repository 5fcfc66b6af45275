// Named densities that change into each other along the paths: c_k' = f_k(c, X, t) for the concentrations c = w / v of a
// particle with weights w and volume v. docs/method.md, section 17.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "effect/effect.hpp"
#include "expression/expression.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift {

/// Named densities of a case, at most: as many numbers as a particle may add to sums of a run at a time.
constexpr std::size_t most_tracers = 16;

/// True if some tracer of the case changes along the paths.
bool tracers_react(const Case& spec);

/// True if what each tracer gains is a sum of multiples of tracers, as far as samples tell: then weights change into each
/// other whatever the volume of a particle is, and blobs may lie upon each other.
bool tracers_react_linearly(const Case& spec);

class TracerReactions : public Effect, private PathIntegral {
 public:
  /// cell: the volume of a particle at the start. The case and the velocity must outlive it.
  /// `volumes_are_kept`: another effect keeps Particles::volume.
  TracerReactions(const Case& spec, const VelocityField& velocity, double cell, bool volumes_are_kept = false);

  std::string name() const override { return "tracers"; }
  std::string describe() const override;
  Changes changes() const override { return {.weight = true}; }
  std::string conserves() const override { return "what the rates leave alone"; }
  double stable_step() const override { return stable_step_; }
  void look_at(const Particles& sample) override;
  void begin(Particles& particles, double time) override;

  /// Its rows are the last ones of Particles::path: a change of weight for each tracer, and where volumes count, their
  /// exponent.
  const PathIntegral* path_integral() const override { return this; }
  /// Throws NumericalError where a weight is not finite.
  void settle(Particles& particles, const double* integral, double time) override;

 private:
  std::size_t rows() const override { return names_.size() + (follows_volume_ ? 1 : 0); }
  void add_rates(double t, const Particles& particles, std::size_t first, const PointsView& x, const double* gathered,
                 double* rates) const override;
  std::string quantity() const override { return "the rate of a named density"; }

  const VelocityField& velocity_;
  TimeSpec clock_;
  int dimension_;
  std::vector<std::string> names_, texts_;
  std::vector<std::vector<Expression>> gains_;  // of each tracer: one or none
  std::vector<double> decay_;                   // of each tracer
  double cell_;
  double unit_;  // of the rows: the largest weight
  bool follows_volume_, volumes_are_kept_;
  double stable_step_;
};

}  // namespace gaussdrift
