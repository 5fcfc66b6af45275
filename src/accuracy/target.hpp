// The cheapest settings whose predicted error meets a target. method.md, section 10.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "accuracy/budget.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::accuracy {

struct AccuracyChoice {
  Case spec;  // with the chosen settings
  double target = 0;
  Budget predicted;
  std::vector<std::string> settings;  // "particles.per_axis = 215", ...
  std::string left_out;               // what was not tried because the work of a search is limited; empty: nothing
  std::size_t lattices = 0;           // tried
  double work = 0;                    // of their predictions (sim/work.hpp)
};

/// Work of a search for settings: ten seconds of one core. Judging the chosen settings may take as much again.
constexpr double most_work_of_search = 2.5e8;

/// Chooses particles.per_axis, overlap and cutoff, time.step and evaluate.tolerance at the least predicted cost. The
/// predicted largest error at the last output, relative to max |rho|, is between a fifth of the target and the
/// target. Throws InputError where no budget covers the case, or where the target cannot be met with at most
/// `most_particles` particles or by a search of at most `most_work`, naming the error that can. `doing` is told what
/// comes next.
AccuracyChoice choose_for_accuracy(const Case& spec, double target, int threads,
                                   const std::function<void(const std::string&)>& doing = {},
                                   double most_work = most_work_of_search);

/// One line for people.
std::string to_text(const AccuracyChoice& choice);

}  // namespace gaussdrift::accuracy
