// Solutions to nearly full precision by the explicit Runge-Kutta method of order 8 of Dormand and Prince. Error
// estimates of orders 5 and 3 choose its steps [HNW93, II.5 and II.10]. method.md, section 7.
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "time/tableau.hpp"

namespace gaussdrift::time {

/// Order 8, 12 stages. Not among tableaux(): it is for references, not for the steps of a run.
const Tableau& dormand_prince_8();

/// The bounds that one component of the state sets to a step.
struct StepBound {
  double absolute = 1e-12;  // the estimated error of a step is at most absolute + relative |y|
  double relative = 0;
  double largest_move = 0;  // a step is not longer than this over |dy/dt|; 0: any
  // Nor is a step longer than this part of |y - middle| over |dy/dt|, if that is more; beyond that distance `absolute`
  // grows in proportion.
  double share_of_distance = 0;
  double middle = 0;
};

/// Both ends of a step that was taken: the state there, and its rate.
struct StepTaken {
  double from = 0, to = 0;
  const double *before = nullptr, *after = nullptr, *rate_before = nullptr, *rate_after = nullptr;
};

struct AdaptiveOptions {
  std::vector<StepBound> components{};
  double longest_step = 0;                                  // 0: any
  std::size_t most_steps = 100'000;                         // taken or rejected
  std::function<void(const StepTaken& step)> after_step{};  // empty: nobody looks
};

struct AdaptiveResult {
  bool reached = false;  // the end; else `time` is where it went no further and `state` what it was there
  double time = 0;
  std::size_t steps = 0, rejected = 0;
  bool exhausted = false;  // too many steps, whatever the reason
  std::string trouble;     // empty if reached
};

/// k[c * points + i] = dy_c/dt of point i at (t, y); must overwrite k. Not finite is allowed: such a step is tried
/// again with a shorter one.
using BlockRate = std::function<void(double t, const double* y, double* k)>;

/// Carries `points` independent points with components.size() numbers each, state[c * points + i], from `begin` to
/// `end` (either may be the later one). All take the same steps: the shortest that any of them needs.
AdaptiveResult integrate_adaptively(const BlockRate& rate, double begin, double end, std::size_t points,
                                    const AdaptiveOptions& options, double* state);

}  // namespace gaussdrift::time
