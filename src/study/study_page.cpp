#include "study/study_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/escaped.hpp"
#include "render/chart_page.hpp"
#include "render/ticks.hpp"
#include "study/study.hpp"
#include "write/provenance.hpp"

namespace gaussdrift::study {

namespace {

using base::escaped;

std::string number_cell(double value, int digits) {
  return fmt::format("<td class=n>{}</td>", std::isfinite(value) ? render::told_number(value, digits) : "");
}

std::string count_cell(std::size_t count) { return fmt::format("<td class=n>{}</td>", count); }

/// What the columns of numbers show; those that no row has are left out.
struct Column {
  const char* name;
  double Sample::*value;
};
constexpr Column columns[] = {{"error", &Sample::error},
                              {"L1", &Sample::l1},
                              {"L2", &Sample::l2},
                              {"seconds", &Sample::seconds},
                              {"predicted error", &Sample::predicted_error},
                              {"predicted seconds", &Sample::predicted_seconds},
                              {"order", &Sample::order}};

std::string html_table_of(const Experiment& experiment) {
  std::vector<Column> shown;
  for (const Column& column : columns)
    if (std::any_of(experiment.samples.begin(), experiment.samples.end(),
                    [&](const Sample& sample) { return std::isfinite(sample.*column.value); }))
      shown.push_back(column);
  std::string text = "<div class=scroll><table><thead><tr>";
  for (const std::string& key : experiment.keys) text += fmt::format("<th>{}</th>", escaped(key));
  text += "<th></th>";
  for (const Column& column : shown) text += fmt::format("<th class=n>{}</th>", column.name);
  const bool counted = std::any_of(experiment.samples.begin(), experiment.samples.end(),
                                   [](const Sample& sample) { return sample.particles > 0; });
  if (counted) text += "<th class=n>particles</th><th class=n>steps</th>";
  text += "</tr></thead><tbody>\n";
  for (const Sample& sample : experiment.samples) {
    text += sample.on_front ? "<tr class=front>" : "<tr>";
    for (const std::string& value : sample.values) text += fmt::format("<td>{}</td>", escaped(value));
    using Role = Sample::Role;
    const char* role = sample.role == Role::current ? "current" : sample.role == Role::recommended ? "recommended" : "";
    text += fmt::format("<td>{}</td>", role);
    if (!sample.failure.empty()) {
      text += fmt::format("<td class=why colspan={}>{}</td></tr>\n", shown.size() + (counted ? 2 : 0),
                          escaped(sample.failure.substr(0, sample.failure.find('\n'))));
      continue;
    }
    for (const Column& column : shown)
      text += number_cell(sample.*column.value, column.value == &Sample::order ? 2 : 3);
    if (counted) text += count_cell(sample.particles) + count_cell(sample.steps);
    text += "</tr>\n";
  }
  return text + "</tbody></table></div>\n";
}

std::string section_of(const Study& study, const Experiment& experiment) {
  std::string text =
      fmt::format("<section><h2>{}</h2>\n<p>{}</p>\n<p class=verdict>{}</p>\n", escaped(experiment.title),
                  escaped(experiment.question), escaped(experiment.conclusion));
  text += render::chart_figure(chart_of(study, experiment));
  text += fmt::format("<p class=quiet>Error: {}. Seconds: {}. Rows in bold: nothing faster is as accurate.</p>\n",
                      escaped(experiment.error_is), escaped(experiment.seconds_are));
  text += html_table_of(experiment);
  if (!experiment.notes.empty()) text += "<ul>";
  for (const std::string& note : experiment.notes) text += fmt::format("<li>{}</li>", escaped(note));
  if (!experiment.notes.empty()) text += "</ul>\n";
  return text + "</section>\n";
}

}  // namespace

std::string to_html(const Study& study) {
  const std::string title = escaped(study.title.empty() ? study.case_name : study.title);
  std::string text = fmt::format(
      "<!DOCTYPE html>\n<html lang=en>\n<head>\n<meta charset=utf-8>\n"
      "<meta name=viewport content=\"width=device-width, initial-scale=1\">\n"
      // Nothing on the page can ask anybody for anything.
      "<meta http-equiv=Content-Security-Policy content=\"default-src 'none';img-src data:;style-src "
      "'unsafe-inline';script-src 'unsafe-inline'\">\n"
      "<title>What accuracy costs: {0}</title>\n<link rel=icon "
      "href=\"data:,\">\n<style>\n{1}{2}{3}</style>\n</head>\n<body>\n"
      "<h1>What accuracy costs: {0}</h1>\n",
      title, render::frame_style(), study_page_files().front().bytes, render::chart_style());
  // What whole runs cost comes first.
  std::for_each(study.experiments.rbegin(), study.experiments.rend(),
                [&](const Experiment& experiment) { text += section_of(study, experiment); });
  text += fmt::format(
      "<p class=quiet>{}; {} threads, {:.0f} s in all. Charts as PNG, SVG and PDF, tables as CSV and JSON "
      "are beside this page.</p>\n",
      escaped(write::made_by()), study.threads, study.seconds);
  return text + fmt::format("<script>\n{}</script>\n</body>\n</html>\n", render::chart_script());
}

}  // namespace gaussdrift::study
