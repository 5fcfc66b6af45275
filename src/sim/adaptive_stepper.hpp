// Carries particles with steps chosen by their error, for methods with an embedded one of lower order. method.md, section 4.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "base/state_bytes.hpp"
#include "effect/drift.hpp"
#include "effect/path_integral.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/particles.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

/// All particles take the same step. Its length is chosen so that the largest error of any particle meets the
/// tolerance. The largest error does not depend on blocks or threads, and the field, the frames and the effects find
/// all particles at one time.
class AdaptiveStepper {
 public:
  struct Options {
    /// Of a position in one step, relative to `length`; of a path integral in one step, absolute.
    double tolerance = 1e-8;
    double length = 1;        // the longest side of the domain
    double largest_step = 0;  // 0: none
    int threads = 0;          // 0: all
  };
  /// The field, the integrals, the drifts and the ranks must outlive the stepper. All ranks take the same steps.
  AdaptiveStepper(const VelocityField& velocity, const time::Tableau& tableau,
                  std::vector<const PathIntegral*> integrals, std::vector<const Drift*> drifts, const Options& options,
                  base::Communicator& ranks)
      : velocity_(velocity),
        tableau_(tableau),
        integrals_(std::move(integrals)),
        drifts_(std::move(drifts)),
        options_(options),
        ranks_(ranks) {}

  /// One step from `time` towards `end`; returns the time reached, exactly `end` if it is reached. Throws
  /// NumericalError naming step, time, particle and place where no step is short enough.
  double advance(Particles& particles, double time, double end, std::size_t steps_before);

  /// The step that it would try next, and what it has counted: writes them, or goes on from them.
  void pass_state(base::StateBytes& bytes) { bytes(proposal_, rejected_); }

  std::size_t rejected() const { return rejected_; }
  /// Seconds that the drifts have taken.
  double drift_seconds() const { return drift_seconds_; }

 private:
  struct Largest {
    double error = 0;          // relative to what is allowed
    std::size_t particle = 0;  // that has it
  };
  std::string why_no_step(const Particles& particles, std::size_t worst, double time, std::size_t step) const;
  Largest attempt(const Particles& particles, double time, double step, std::vector<std::vector<double>>& results);

  const VelocityField& velocity_;
  const time::Tableau& tableau_;
  std::vector<const PathIntegral*> integrals_;
  std::vector<const Drift*> drifts_;
  Options options_;
  base::Communicator& ranks_;
  double proposal_ = 0;  // 0: none yet
  std::size_t rejected_ = 0;
  double drift_seconds_ = 0;
};

}  // namespace gaussdrift
