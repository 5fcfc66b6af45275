// Points of a table that go with the flow of a run: without weight, felt by nobody. They take the steps of the particles,
// on rank 0, and meet edges and coasts as these do.
#pragma once

#include <cstddef>
#include <memory>

#include "base/state_bytes.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"
#include "gaussdrift/stage_times.hpp"
#include "sim/carrier.hpp"

namespace gaussdrift {

class CarriedPoints {
 public:
  /// Case and scene must outlive it. `every`: steps between looks at the points; 0: none but at landings.
  CarriedPoints(const Case& spec, const Scene& scene, std::size_t every, int threads);

  /// Those that have not left the run; ids are -1, -2, ... in the order of the table.
  const Particles& points() const { return points_; }
  Departures& departures() { return carrier_.departures(); }

  /// To where the particles are on their leg, before which they had taken `steps_before` steps.
  void follow(const Carrier::Leg& leg, std::size_t steps_before, StageTimes& stages);

  /// Where they are, and how far: writes it, or takes it up. Throws std::out_of_range if the bytes are not those of this
  /// case.
  void pass_state(base::StateBytes& bytes);

 private:
  static Case without_effects(const Case& spec);

  const Case case_;
  Carrier carrier_;
  Particles points_;
  Carrier::Leg leg_;
};

}  // namespace gaussdrift
