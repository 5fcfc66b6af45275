// What accuracy costs in time: a case run with keys varied, its error beside its seconds, and what follows from them.
#pragma once

#include <cmath>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "render/chart.hpp"

namespace gaussdrift::study {

/// --vary key=a,b,c
struct Variation {
  std::string key;
  std::vector<std::string> values;  // as in --set
};

/// Splits at commas outside of brackets and quotes. Throws CommandLineError where there is no key or no value.
Variation parse_variation(const std::string& text);

/// One combination.
struct Sample {
  std::vector<std::string> values;  // one a key of the experiment
  double seconds = std::numeric_limits<double>::quiet_NaN();
  bool confirmed = true;  // false: measurements of the seconds do not agree
  double error = std::numeric_limits<double>::quiet_NaN();
  double l1 = std::numeric_limits<double>::quiet_NaN(), l2 = l1;  // of whole runs: beside Linf, which `error` is there
  std::size_t particles = 0, steps = 0;
  double order = std::numeric_limits<double>::quiet_NaN();  // observed, against the sample before of the same series
  bool on_front = false;                                    // no other sample is both faster and more accurate
  double predicted_error = std::numeric_limits<double>::quiet_NaN();    // before it was run, where that was asked for
  double predicted_seconds = std::numeric_limits<double>::quiet_NaN();  // the same
  enum class Role { none, current, recommended };
  Role role = Role::none;  // the settings of the case, those to take in their place
  std::string failure{};   // why there is no number; empty: there is
};

/// One question, one chart.
struct Experiment {
  std::string name;      // of its files: "steps"
  std::string title;     // "Step and integrator"
  std::string question;  // "How long may steps be?"
  std::vector<std::string> keys;
  std::string error_is;     // "Linf at the last output"
  std::string seconds_are;  // "of transport and density, without the reference"
  std::vector<Sample> samples;
  std::string conclusion;
  std::vector<std::string> notes;  // what was left out, expected orders
};

struct StudyOptions {
  std::filesystem::path file;
  std::vector<std::string> overrides;
  std::vector<Variation> vary;  // empty: the standard studies
  int repeats = 3;              // of cheap runs, after one to warm up; the fastest counts
  double seconds = 90;          // about what the standard studies may take
  int threads = 0;
  double most_memory = std::numeric_limits<double>::infinity();  // bytes; what would take more is refused
  std::function<void()> begins{};                                // called once the case is read and fits
  std::function<void(const std::string&)> progress{};
  std::function<void(const Experiment&)>
      table_grew{};  // by a sample, or several; for tables that survive an interruption
};

struct Study {
  std::string case_name, title;
  std::vector<Experiment> experiments;
  int threads = 1;
  double seconds = 0;
};

/// Throws what reading the case throws; CommandLineError for more than 2000 combinations, a key that cannot be
/// varied or is given twice; InputError where keys are varied and the case has no exact density, and where no keys are
/// and the case has sources. A combination that cannot run is a sample that says why.
Study run_study(const StudyOptions& options);

/// Marks the front and fills in observed orders along the last key, where it is a number that errors are powers of.
void finish(Experiment& experiment, const Case& spec);

/// The expected order along a key: the power of a length or a step with which the error falls. For particles.overlap
/// and 1/particles.per_axis it is that of the cutoff, for time.step that of the method; nothing for others.
std::optional<double> expected_order(const std::string& key, const Case& spec);

std::string to_text(const Study& study);
std::string to_csv(const Experiment& experiment);
/// All experiments in one table, with a column for the experiment and one for the settings, "key=value key=value".
std::string to_csv(const Study& study);
std::string to_json(const Study& study);
/// A text for people: charts, tables, conclusions. The charts are files beside it.
std::string to_markdown(const Study& study);
/// The same as a page that needs no other file and no network: charts that tell their numbers, tables.
std::string to_html(const Study& study);

/// Error against seconds: every sample, the front, predictions, the current and the recommended settings.
render::Chart chart_of(const Study& study, const Experiment& experiment);
/// Writes the chart of every experiment into the folder, as files called like it (render/chart.hpp). Throws FileError.
void write_charts(const Study& study, const std::filesystem::path& folder);

// The standard studies; standard_studies.hpp lists them.
Experiment study_transform(const Case& spec, int threads, double seconds);
Experiment study_steps(const Case& spec, int threads, double seconds);
Experiment study_lattice(const Case& spec, const StudyOptions& options, double seconds);
Experiment study_whole(const Case& spec, const StudyOptions& options, double seconds);

/// Runs the case without files and pictures: error at the last output, the fastest of its times.
Sample measure_run(const Case& spec, const StudyOptions& options);

}  // namespace gaussdrift::study
