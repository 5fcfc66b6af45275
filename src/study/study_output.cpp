// A study as text, tables, JSON, a page, and charts.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "render/picture.hpp"
#include "study/study.hpp"
#include "write/provenance.hpp"

namespace gaussdrift::study {

namespace {

std::string short_number(double value, const char* missing = "") {
  return std::isfinite(value) ? fmt::format("{:.2e}", value) : missing;
}

/// Columns of one table, padded.
std::string table_of(const Experiment& experiment) {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::string> header = experiment.keys;
  const bool norms = std::any_of(experiment.samples.begin(), experiment.samples.end(),
                                 [](const Sample& sample) { return std::isfinite(sample.l1); });
  header.push_back("error");
  if (norms)
    for (const char* name : {"L1", "L2"}) header.push_back(name);
  for (const char* name : {"seconds", "order", "particles", "steps", ""}) header.push_back(name);
  rows.push_back(header);
  for (const Sample& sample : experiment.samples) {
    std::vector<std::string> row = sample.values;
    if (!sample.failure.empty()) {
      row.push_back("-- " + sample.failure.substr(0, sample.failure.find('\n')));
    } else {
      row.push_back(short_number(sample.error));
      if (norms)
        for (const double norm : {sample.l1, sample.l2}) row.push_back(short_number(norm));
      row.push_back(short_number(sample.seconds));
      row.push_back(std::isfinite(sample.order) ? fmt::format("{:.1f}", sample.order) : "");
      row.push_back(sample.particles ? std::to_string(sample.particles) : "");
      row.push_back(sample.steps ? std::to_string(sample.steps) : "");
      row.push_back(sample.on_front ? "*" : "");
    }
    rows.push_back(row);
  }
  std::vector<std::size_t> width(header.size(), 0);
  for (const auto& row : rows)
    if (row.size() == header.size())
      for (std::size_t k = 0; k < row.size(); ++k) width[k] = std::max(width[k], row[k].size());
  for (const auto& row : rows)
    for (std::size_t k = 0; k < experiment.keys.size(); ++k) width[k] = std::max(width[k], row[k].size());
  std::string text;
  for (const auto& row : rows) {
    std::string line = " ";
    for (std::size_t k = 0; k < row.size(); ++k) line += fmt::format(" {:<{}}", row[k], width[k]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c == '\n' ? ' ' : c);
  return quoted + "\"";
}

constexpr const char* csv_header =
    "error,L1,L2,seconds,order,particles,steps,front,predicted_error,predicted_seconds,failure\n";

std::string csv_numbers(const Sample& sample) {
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{:.6e}", value) : ""; };
  return fmt::format("{},{},{},{},{},{},{},{},{},{},{}\n", number(sample.error), number(sample.l1), number(sample.l2),
                     number(sample.seconds), number(sample.order), sample.particles, sample.steps,
                     sample.on_front ? 1 : 0, number(sample.predicted_error), number(sample.predicted_seconds),
                     csv_field(sample.failure));
}

}  // namespace

std::string to_text(const Study& study) {
  std::string text;
  for (const Experiment& experiment : study.experiments) {
    text += fmt::format("{}\n  {}; seconds {}; * no other is faster and more accurate\n{}", experiment.title,
                        experiment.error_is, experiment.seconds_are, table_of(experiment));
    for (const std::string& note : experiment.notes) text += fmt::format("  {}\n", note);
    text += fmt::format("=> {}\n\n", experiment.conclusion);
  }
  return text;
}

std::string to_csv(const Experiment& experiment) {
  std::string text;
  for (const std::string& key : experiment.keys) text += csv_field(key) + ",";
  text += csv_header;
  for (const Sample& sample : experiment.samples) {
    for (const std::string& value : sample.values) text += csv_field(value) + ",";
    text += csv_numbers(sample);
  }
  return text;
}

std::string to_csv(const Study& study) {
  std::string text = std::string("experiment,settings,") + csv_header;
  for (const Experiment& experiment : study.experiments)
    for (const Sample& sample : experiment.samples) {
      std::string settings;
      for (std::size_t k = 0; k < experiment.keys.size(); ++k)
        settings += (k ? " " : "") + experiment.keys[k] + "=" + sample.values[k];
      text += csv_field(experiment.name) + "," + csv_field(settings) + "," + csv_numbers(sample);
    }
  return text;
}

std::string to_json(const Study& study) {
  using json = nlohmann::ordered_json;
  const auto number = [](double value) { return std::isfinite(value) ? json(value) : json(nullptr); };
  json experiments = json::array();
  for (const Experiment& experiment : study.experiments) {
    json samples = json::array();
    for (const Sample& sample : experiment.samples) {
      json row = json::object();
      for (std::size_t k = 0; k < experiment.keys.size(); ++k) row[experiment.keys[k]] = sample.values[k];
      row["error"] = number(sample.error);
      if (std::isfinite(sample.l1)) {
        row["L1"] = sample.l1;
        row["L2"] = number(sample.l2);
      }
      row["seconds"] = number(sample.seconds);
      row["order"] = number(sample.order);
      row["particles"] = sample.particles;
      row["steps"] = sample.steps;
      row["front"] = sample.on_front;
      if (std::isfinite(sample.predicted_error)) row["predicted_error"] = sample.predicted_error;
      if (std::isfinite(sample.predicted_seconds)) row["predicted_seconds"] = sample.predicted_seconds;
      if (sample.role != Sample::Role::none)
        row["role"] = sample.role == Sample::Role::current ? "current" : "recommended";
      if (!sample.failure.empty()) row["failure"] = sample.failure;
      samples.push_back(row);
    }
    experiments.push_back({{"name", experiment.name},
                           {"title", experiment.title},
                           {"error", experiment.error_is},
                           {"seconds", experiment.seconds_are},
                           {"samples", samples},
                           {"conclusion", experiment.conclusion},
                           {"notes", experiment.notes}});
  }
  return json{{"case", study.case_name},
              {"threads", study.threads},
              {"made_by", write::made_by()},
              {"seconds", study.seconds},
              {"experiments", experiments}}
             .dump(2, ' ', false, json::error_handler_t::replace) +
         "\n";
}

std::string to_markdown(const Study& study) {
  std::string text = fmt::format("# What accuracy costs: {}\n\n", study.title.empty() ? study.case_name : study.title);
  const char* ending = render::unavailable_reason().empty() ? ".png" : ".svg";
  for (const Experiment& experiment : study.experiments) {
    text += fmt::format("## {}\n\n{}\n\n![{}]({}{})\n\n**{}**\n\n", experiment.title, experiment.question,
                        experiment.title, experiment.name, ending, experiment.conclusion);
    text += fmt::format("Error: {}. Seconds: {}. `*`: no other is faster and more accurate.\n\n```\n{}```\n\n",
                        experiment.error_is, experiment.seconds_are, table_of(experiment));
    for (const std::string& note : experiment.notes) text += fmt::format("* {}\n", note);
    text += "\n";
  }
  text += fmt::format("{}; {} threads, {:.0f} s in all; tables as CSV and JSON beside this page.\n", write::made_by(),
                      study.threads, study.seconds);
  return text;
}

}  // namespace gaussdrift::study
