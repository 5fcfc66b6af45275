// The studies that `gaussdrift study CASE` makes by itself, a file each, and what they share.
#pragma once

#include <string>
#include <vector>

#include "study/study.hpp"

namespace gaussdrift::study {

struct StandardStudy {
  const char* name;       // of its experiment
  const char* meaning;    // what is studied, for people who wait
  double share;           // of the seconds of all of them
  bool compares_density;  // needs a case with an exact density
  Experiment (*make)(const Case& spec, const StudyOptions& options, double seconds);
};

/// In the order in which they are made.
const std::vector<StandardStudy>& standard_studies();

/// The sample with the fewest seconds whose error is at most this; null if there is none.
template <class SomeExperiment>
auto cheapest_below(SomeExperiment& experiment, double error) {
  decltype(experiment.samples.data()) best = nullptr;
  for (auto& sample : experiment.samples)
    if (sample.failure.empty() && sample.error <= error && (!best || sample.seconds < best->seconds)) best = &sample;
  return best;
}

/// The conclusion where no run has an error.
std::string no_error(const Experiment& experiment);

/// The settings of a sample, as in --set.
std::string settings_of(const Sample& sample, const std::vector<std::string>& keys);

}  // namespace gaussdrift::study
