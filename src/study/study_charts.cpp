// Error against seconds.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/number.hpp"
#include "render/chart.hpp"
#include "render/ticks.hpp"
#include "study/study.hpp"
#include "write/provenance.hpp"

namespace gaussdrift::study {

namespace {

using render::ChartPoint;
using render::ChartSeries;
using render::told_number;
using Look = ChartSeries::Look;
using Role = Sample::Role;

constexpr int current_colour = 1, recommended_colour = 2, predicted_colour = 3;

/// "auto", "overlap 2": of all keys but the last.
std::string name_of(const Experiment& experiment, const Sample& sample) {
  std::string name;
  for (std::size_t k = 0; k + 1 < sample.values.size() && k + 1 < experiment.keys.size(); ++k) {
    const std::string& key = experiment.keys[k];
    const std::string& value = sample.values[k];
    const bool is_number = !value.empty() && value.find_first_not_of("0123456789.e+-") == std::string::npos;
    const std::string word = is_number ? key.substr(key.rfind('.') + 1) + " " : "";
    name += (name.empty() ? "" : ", ") + word + value;
  }
  return name;
}

/// What a sample is: its settings, its numbers.
std::string told_of(const Experiment& experiment, const Sample& sample) {
  std::string text;
  for (std::size_t k = 0; k < experiment.keys.size() && k < sample.values.size(); ++k)
    text += fmt::format("{}{} = {}", k ? ", " : "", experiment.keys[k], sample.values[k]);
  text += fmt::format("\nerror {} in {} s", told_number(sample.error, 3), told_number(sample.seconds, 3));
  if (std::isfinite(sample.predicted_error) && std::isfinite(sample.predicted_seconds))
    text += fmt::format("; predicted {} in {} s", told_number(sample.predicted_error, 3),
                        told_number(sample.predicted_seconds, 3));
  return text;
}

/// "0.001" as it is, "tolerance 1e-05" with a power of ten.
std::string label_of(const std::string& value) {
  const std::size_t last = value.rfind(' ') + 1;  // of the last word
  if (value.find('e', last) == std::string::npos) return value;
  const auto number = base::read_number<double>(value.substr(last));
  return number ? value.substr(0, last) + told_number(*number, 4) : value;
}

ChartSeries front_of(const Experiment& experiment) {
  ChartSeries front{.name = "nothing faster is as accurate", .look = Look::dashed, .quiet = true};
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty() && sample.on_front) front.points.push_back({sample.seconds, sample.error});
  std::sort(front.points.begin(), front.points.end(), [](const auto& a, const auto& b) { return a.x < b.x; });
  if (front.points.size() < 2) front.name.clear();
  return front;
}

/// A series for each combination of all keys but the last.
std::vector<ChartSeries> measured_series(const Experiment& experiment) {
  std::vector<ChartSeries> all;
  std::vector<std::string> names;  // as they are told apart
  const bool single = experiment.keys.size() == 1;
  for (const Sample& sample : experiment.samples) {
    if (!sample.failure.empty()) continue;
    const std::string name = name_of(experiment, sample);
    auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), name) - names.begin());
    if (at == names.size()) {
      names.push_back(name);
      all.push_back({.name = single ? "measured" : name, .look = single ? Look::marks : Look::both});
    }
    const std::string label = single && sample.role != Role::none ? "" : label_of(sample.values.back());
    all[at].points.push_back({sample.seconds, sample.error, label, told_of(experiment, sample)});
  }
  return all;
}

/// Where the predictions of the same settings are.
ChartSeries predicted_series(const Experiment& experiment) {
  ChartSeries predicted{.name = "predicted", .look = Look::marks, .quiet = false, .colour = predicted_colour};
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty() && std::isfinite(sample.predicted_error) && std::isfinite(sample.predicted_seconds))
      predicted.points.push_back({sample.predicted_seconds, sample.predicted_error, "", told_of(experiment, sample)});
  if (predicted.points.empty()) predicted.name.clear();
  return predicted;
}

/// From each prediction to what came true.
std::vector<ChartSeries> misses(const Experiment& experiment) {
  std::vector<ChartSeries> all;
  for (const Sample& sample : experiment.samples)
    if (sample.failure.empty() && std::isfinite(sample.predicted_error) && std::isfinite(sample.predicted_seconds))
      all.push_back({.name = "",
                     .points = {{sample.predicted_seconds, sample.predicted_error}, {sample.seconds, sample.error}},
                     .look = Look::line,
                     .quiet = true});
  return all;
}

/// The samples that the reader looks for, each with its name.
std::vector<ChartSeries> chief_series(const Experiment& experiment) {
  std::vector<ChartSeries> chief;
  for (const Sample& sample : experiment.samples) {
    if (sample.role == Role::none || !sample.failure.empty()) continue;
    const bool is_current = sample.role == Role::current;
    std::string name = is_current ? "current" : "recommended";
    if (!is_current && experiment.keys == std::vector<std::string>{"accuracy.target"})
      name += ": --accuracy " + sample.values.back();
    name += fmt::format(": {} in {} s", told_number(sample.error, 2), told_number(sample.seconds, 2));
    chief.push_back({.name = name,
                     .points = {{sample.seconds, sample.error, "", told_of(experiment, sample)}},
                     .look = Look::marks,
                     .filled = true,
                     .colour = is_current ? current_colour : recommended_colour});
  }
  return chief;
}

}  // namespace

render::Chart chart_of(const Study& study, const Experiment& experiment) {
  render::Chart chart{.title = experiment.title,
                      .x = render::ChartAxis{.name = "seconds " + experiment.seconds_are, .logarithmic = true},
                      .y = render::ChartAxis{.name = experiment.error_is, .logarithmic = true},
                      .series = {front_of(experiment)}};
  const auto add = [&](std::vector<ChartSeries> some) {
    chart.series.insert(chart.series.end(), some.begin(), some.end());
  };
  add(misses(experiment));
  add(measured_series(experiment));
  add({predicted_series(experiment)});
  add(chief_series(experiment));
  chart.conclusion = experiment.conclusion;
  const std::string labels =
      experiment.keys.empty() ? "" : fmt::format("Beside the marks: {}. ", experiment.keys.back());
  chart.footer = fmt::format("{}{}; {}; {} threads", labels, study.title.empty() ? study.case_name : study.title,
                             write::made_by(), study.threads);
  return chart;
}

void write_charts(const Study& study, const std::filesystem::path& folder) {
  for (const Experiment& experiment : study.experiments)
    render::write_chart(chart_of(study, experiment), folder / experiment.name);
}

}  // namespace gaussdrift::study
