// gaussdrift study: what accuracy costs in time.
#include <fmt/format.h>

#include <cstdio>
#include <optional>

#include "cli/asked_case.hpp"
#include "cli/output_name.hpp"
#include "cli/owed_files.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/error.hpp"
#include "render/chart.hpp"
#include "render/picture.hpp"
#include "study/study.hpp"
#include "write/atomic_file.hpp"
#include "write/folder_facts.hpp"
#include "write/result_folder.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct StudyVerbOptions {
  CaseOptions case_options;
  std::vector<std::string> vary;  // --vary key=a,b,c; none: the standard studies
  int repeats = 3;
  double seconds = 90;
  fs::path folder;  // --out; empty: output/study_<case name>
  fs::path csv;     // --csv; empty: the tables in the folder alone
  bool force = false;
};

void declare(OptionList& options, StudyVerbOptions& given) {
  declare_case(options, given.case_options);
  options
      .add("--vary", given.vary, "KEY=A,B,...",
           "run with these values of a key: --vary time.step=0.1,0.05. Repeatable: then every combination. Without it, "
           "the standard studies")
      .repeatable();
  options.add("--repeats", given.repeats, "N", "how often a cheap run is timed. The fastest counts; 3 by default")
      .within(1, 100);
  options.add("--seconds", given.seconds, "S", "about how long the standard studies may take; 90 by default")
      .within(1., 100000.);
  options.add("--out", given.folder, "DIR", "folder for tables and charts; output/study_<case> by default");
  options.add("--csv", given.csv, "FILE", "also write all results as one table");
  options.flag("--force", given.force, "replace an earlier study in that folder");
}

ExitCode study(const StudyVerbOptions& options) {
  check_folder_name(options.folder,
                    "a study leaves a folder with a page (HTML), tables (CSV) and charts (PNG, SVG, PDF)");
  study::StudyOptions wanted;
  wanted.file = options.case_options.file;
  wanted.overrides = options.case_options.overrides;
  wanted.repeats = options.repeats;
  wanted.seconds = options.seconds;
  wanted.threads = options.case_options.threads;
  wanted.most_memory = most_memory(options.case_options.memory);
  for (const std::string& text : options.vary) wanted.vary.push_back(study::parse_variation(text));
  const fs::path folder = options.folder.empty()
                              ? fs::path("output") / ("study_" + options.case_options.file.stem().string())
                              : options.folder;
  using Earlier = write::ResultFolder::Earlier;
  std::optional<write::ResultFolder> place;
  wanted.begins = [&] {  // what is refused leaves no folder
    place.emplace(folder, "study", options.force ? Earlier::replace : Earlier::refuse,
                  options.force ? write::files_of_study(folder) : write::OwnFiles({"study.json"}));
  };
  study::Study result;
  {
    ProgressLine line;
    wanted.progress = [&](const std::string& what) { line.show(what); };
    // Written anew whenever a table grows, so that an interrupted study leaves what it has.
    wanted.table_grew = [&](const study::Experiment& experiment) {
      write::write_text(place->claim(experiment.name + ".csv"), study::to_csv(experiment));
      place->has_result();
    };
    result = study::run_study(wanted);
  }
  const std::string json = study::to_json(result);
  OwedFiles owed;
  for (const study::Experiment& experiment : result.experiments)
    owed.attempt([&] { write::write_text(place->claim(experiment.name + ".csv"), study::to_csv(experiment)); });
  owed.attempt([&] { write::write_text(place->claim("study.json"), json); });
  owed.attempt([&] { write::write_text(place->claim("study.md"), study::to_markdown(result)); });
  owed.attempt([&] { write::write_text(place->claim("study.html"), study::to_html(result)); });
  owed.attempt([&] {
    for (const study::Experiment& experiment : result.experiments)
      for (const std::string_view ending : render::chart_endings()) place->claim(experiment.name + std::string(ending));
    study::write_charts(result, folder);
  });
  owed.attempt([&] { place->has_result(), place->complete(); });
  if (!options.csv.empty())
    owed.attempt([&] {
      write::write_text(options.csv, result.experiments.size() == 1 ? study::to_csv(result.experiments.front())
                                                                    : study::to_csv(result));
    });
  if (const std::string reason = render::unavailable_reason(); !reason.empty())
    note("warning: charts are written as SVG and PDF alone: {}\n", reason);
  if (options.case_options.json)
    put(stdout, json);
  else
    say("{}open   {}, charts beside it\n", study::to_text(result), (folder / "study.html").string());
  for (const std::string& why : owed.missing()) note("error: {}\n", why);
  return owed.code();
}

}  // namespace

Verb study_verb() {
  return make_verb<StudyVerbOptions>("study", "measure what accuracy costs in time: tables, charts, a conclusion",
                                     declare, study);
}

}  // namespace gaussdrift::cli
