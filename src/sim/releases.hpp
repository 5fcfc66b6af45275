// What sources release during a run, [[source]] of a case: at which times, how much, and as which particles.
// docs/decisions/0036-releases-are-landings.md.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/exact_sum.hpp"
#include "base/state_bytes.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/lattice.hpp"
#include "gaussdrift/particles.hpp"
#include "sim/inflow.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {

/// The times at which something is released, ascending. An interval has one in the middle of each of its puffs.
std::vector<double> release_times(const Case& spec);

/// An upper estimate of the particles that are released until time.end, from a lattice of a hundred thousand points.
double particles_released(const Case& spec, int threads);

class Releases {
 public:
  /// Nothing where the case has no sources. Shapes are put on the points of the lattice as densities at the start are.
  /// Throws InputError for a shape that has no point there and for a face where nothing comes in, NumericalError for a
  /// rate that is not finite. The scene must outlive it.
  Releases(const Case& spec, const Scene& scene, int threads);

  /// False: nothing is ever released, and nobody need ask.
  bool possible() const { return !puffs_.empty(); }

  /// Appends the particles that are due until `time` and were not released before, those whose place `is_here`; ids
  /// still ascend. True if some were due, here or elsewhere. All ranks call it with the same times.
  bool release(Particles& particles, double time, const std::function<bool(const Vector& place)>& is_here);

  /// The time at which the particle of this id began; 0 for those of the lattice.
  double began(std::int64_t id) const;
  /// Ids of released particles are below it, also of those that are yet to come. Without any: what the lattice has.
  std::int64_t ids_end() const { return ids_end_; }

  /// The sum of the weights released so far, on all ranks.
  double released() const { return sum_.value(); }

  /// The same of one tracer.
  double released(std::size_t tracer) const { return of_tracers_[tracer].value(); }

  /// Places of some particles that are going to be released, appended to a sample of those that are there.
  void add_places(Particles& sample, std::size_t most) const;

  /// What is not exact about the releases of this case, as sentences for the user.
  const std::vector<std::string>& warnings() const { return warnings_; }

  /// How far it is: writes it, or takes it up.
  void pass_state(base::StateBytes& bytes);

 private:
  /// Particles [first, first + count) of those of a source, with weights `times` as large.
  struct Puff {
    double time = 0, times = 1;
    std::size_t source = 0, first = 0, count = 0;
    std::int64_t id = 0;      // of the first
    double from = 0, to = 0;  // of a face: when it comes in
  };
  std::vector<double> weights_of(const Puff& puff) const;
  void add_source(const Case& spec, const Scene& scene, std::size_t number, int threads);
  void look_at_face(const Scene& scene, const Inflow& face, const SourceSpec& source);
  void add_puffs(const Case& spec, std::size_t number, std::size_t count);
  std::vector<Particles> of_sources_;           // positions and weights alone
  std::vector<std::size_t> tracer_;             // that each of them releases
  std::vector<std::unique_ptr<Inflow>> faces_;  // of the sources that are faces; null for others
  std::vector<Puff> puffs_;                     // by time
  std::vector<std::string> warnings_;
  double rounding_ = 0;  // of times
  std::int64_t ids_end_ = 0;
  std::uint64_t done_ = 0;
  base::ExactSum sum_;
  std::vector<base::ExactSum> of_tracers_;
};

}  // namespace gaussdrift
