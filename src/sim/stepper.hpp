// Carries particles through the velocity field: X_j' = u(X_j, t), by any explicit Runge-Kutta method.
#pragma once

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "effect/drift.hpp"
#include "effect/path_integral.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/particles.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

/// Throws NumericalError naming step, time, particle and place where a velocity or a position is not finite.
void check_velocity(const VelocityField& field, const Particles& particles, const VectorsView& u, double time,
                    std::size_t step);

/// The velocity of the flow and of all drifts, for all particles at once. The flow uses several threads, and blocks if
/// the field allows them. Returns the seconds of the drifts. With drifts all ranks call it together, and agree on errors;
/// null: there are no others.
double add_flow_and_drifts(const VelocityField& velocity, const std::vector<const Drift*>& drifts, double t,
                           const Particles& particles, const PointsView& x, const VectorsView& u, int threads,
                           base::Communicator* ranks = nullptr);

/// Does what must not communicate, and agrees on how it went where there are ranks.
template <class Work>
void agree_on(base::Communicator* ranks, const Work& work) {
  if (ranks)
    ranks->agree_on(work);
  else
    work();
}

/// Seconds of one advance() beside those of the flow.
struct StepperSeconds {
  double integrals = 0;  // summed over threads
  double drifts = 0;
};

/// Particles do not see each other, so each block of them takes many steps at a time while its arrays stay in the
/// cache. All are in one block if the field is evaluated for all at once, or if particles move each other. The result
/// of a particle does not depend on the blocks or the number of threads. A field with a kernel for many steps
/// (VelocityField::block_carrier) takes them there, with the same bits. One thread at a time may call advance().
class Stepper {
 public:
  /// The field, the integrals, the drifts and the ranks must outlive the stepper. threads: 0 for all. ranks: that share
  /// the particles, if there are drifts; null: none.
  Stepper(const VelocityField& velocity, const time::Tableau& tableau, int threads,
          std::vector<const PathIntegral*> integrals = {}, std::vector<const Drift*> drifts = {},
          base::Communicator* ranks = nullptr)
      : velocity_(velocity),
        tableau_(tableau),
        threads_(threads),
        integrals_(std::move(integrals)),
        drifts_(std::move(drifts)),
        ranks_(drifts_.empty() ? nullptr : ranks) {}

  /// Takes steps first .. first + count - 1 of the interval. `steps_before` steps were taken before the interval;
  /// messages count from there. Throws NumericalError naming step, time, particle and place where the field or a
  /// position is not finite. The particles then stay as they were. particles.path has an array for each integral, which
  /// is added to. With drifts all ranks call it together, and agree on errors.
  StepperSeconds advance(Particles& particles, const time::Interval& interval, std::size_t first, std::size_t count,
                         std::size_t steps_before) const;

 private:
  /// The steps of advance() by the field's kernel. False if a position is not finite; the particles then stay as they were.
  bool carry_in_registers(const BlockCarrier& carrier, Particles& particles, const time::Interval& interval,
                          std::size_t first, std::size_t count) const;

  const VelocityField& velocity_;
  const time::Tableau& tableau_;
  int threads_;
  std::vector<const PathIntegral*> integrals_;
  std::vector<const Drift*> drifts_;
  base::Communicator* ranks_;
  mutable std::array<std::vector<double>, max_dimension>
      carried_;  // positions on their way; kept, since fresh memory is slow
};

}  // namespace gaussdrift
