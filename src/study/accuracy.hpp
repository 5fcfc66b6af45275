// The cheapest settings whose predicted error meets a target. method.md, section 10.
#pragma once

#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "study/budget.hpp"

namespace gaussdrift::study {

struct AccuracyChoice {
  Case scene;  // with the chosen settings
  double target = 0;
  Budget predicted;
  std::vector<std::string> settings;  // "particles.per_axis = 215", ...
};

/// Chooses particles.per_axis, overlap and cutoff, time.step and evaluate.tolerance so that the largest error at the
/// last output, relative to max |rho|, is predicted to be between a fifth of the target and the target, at the least
/// predicted cost. Throws InputError where no budget covers the case, or where the target cannot be met with at most
/// `most_particles` particles, naming the error that can.
AccuracyChoice choose_for_accuracy(const Case& description, double target, int threads);

/// One line for people.
std::string to_text(const AccuracyChoice& choice);

}  // namespace gaussdrift::study
