#include "study/standard_studies.hpp"

#include <fmt/format.h>

namespace gaussdrift::study {

const std::vector<StandardStudy>& standard_studies() {
  using Options = StudyOptions;
  static const std::vector<StandardStudy> all{{"transform", "the Gauss transform", 0.1, false,
                                               [](const Case& spec, const Options& options, double seconds) {
                                                 return study_transform(spec, options.threads, seconds);
                                               }},
                                              {"steps", "steps", 0.15, false,
                                               [](const Case& spec, const Options& options, double seconds) {
                                                 return study_steps(spec, options.threads, seconds);
                                               }},
                                              {"lattice", "lattice and cutoff", 0.4, true, study_lattice},
                                              {"whole", "whole runs", 0.35, true, study_whole}};
  return all;
}

std::string no_error(const Experiment& experiment) {
  return experiment.samples.empty() ? "Nothing was run."
                                    : fmt::format("No run has a known error: {}.", experiment.samples.front().failure);
}

std::string settings_of(const Sample& sample, const std::vector<std::string>& keys) {
  std::string text;
  for (std::size_t k = 0; k < keys.size() && k < sample.values.size(); ++k) {
    std::string key = keys[k], value = sample.values[k];
    if (value.rfind("tolerance ", 0) == 0) key = "time.tolerance", value = value.substr(10);
    const bool word = key == "time.method" || key == "particles.cutoff";
    text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, word ? '"' + value + '"' : value);
  }
  return text;
}

}  // namespace gaussdrift::study
