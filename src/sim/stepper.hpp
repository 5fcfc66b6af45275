// Carries particles through the velocity field: X_j' = u(X_j, t), by any explicit Runge-Kutta method.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "effect/path_integral.hpp"
#include "field/velocity.hpp"
#include "particle/particles.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

/// Throws NumericalError naming step, time, particle and place where a velocity or a position is not finite.
void check_velocity(const VelocityField& field, const Particles& particles, const VectorsView& u, double time,
                    std::size_t step);

/// Particles do not see each other, so each block of them takes many steps at a time while its arrays stay in the
/// cache; a field that is evaluated best for all at once gets all of them in one block. The result of a particle does
/// not depend on the blocks or the number of threads.
class Stepper {
 public:
  /// The field and the integrals must outlive the stepper. threads: 0 for all.
  Stepper(const VelocityField& velocity, const time::Tableau& tableau, int threads,
          std::vector<const PathIntegral*> integrals = {})
      : velocity_(velocity), tableau_(tableau), threads_(threads), integrals_(std::move(integrals)) {}

  /// Takes steps first .. first + count - 1 of the interval. `steps_before` steps were taken before the interval;
  /// messages count from there. Throws NumericalError naming step, time, particle and place where the field or a
  /// position is not finite; the particles are then as they were before the call. particles.path has an array for each
  /// integral, which is added to. Returns the seconds spent on the integrals, summed over threads.
  double advance(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                 std::size_t steps_before) const;

 private:
  const VelocityField& velocity_;
  const time::Tableau& tableau_;
  int threads_;
  std::vector<const PathIntegral*> integrals_;
};

}  // namespace gaussdrift
