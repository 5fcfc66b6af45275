// gaussdrift study: what accuracy costs in time.
#include <fmt/format.h>

#include <cstdio>

#include "cli/owed_files.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/error.hpp"
#include "render/picture.hpp"
#include "study/study.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// A finished study, or the tables of one that was interrupted.
bool holds_a_study(const fs::path& folder) {
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) return false;
  for (const auto& entry : fs::directory_iterator(folder))
    if (entry.path().filename() == "study.json" || entry.path().extension() == ".csv") return true;
  return false;
}

}  // namespace

ExitCode study(const StudyVerbOptions& options) {
  study::StudyOptions wanted;
  wanted.file = options.scene.file;
  wanted.overrides = options.scene.overrides;
  wanted.repeats = options.repeats;
  wanted.seconds = options.seconds;
  wanted.threads = options.scene.threads;
  for (const std::string& text : options.vary) wanted.vary.push_back(study::parse_variation(text));
  const fs::path folder =
      options.folder.empty() ? fs::path("output") / ("study_" + options.scene.file.stem().string()) : options.folder;
  if (!options.force && holds_a_study(folder))
    throw FileError(
        fmt::format("{} holds an earlier study, or what is left of one; --force replaces it, --out DIR writes "
                    "elsewhere",
                    folder.string()));
  study::Study result;
  {
    ProgressLine line;
    wanted.progress = [&](const std::string& what) { line.show(what); };
    // Written anew whenever a table grows, so that an interrupted study leaves what it has.
    wanted.table_grew = [&](const study::Experiment& experiment) {
      write::write_text(folder / (experiment.name + ".csv"), study::to_csv(experiment));
    };
    result = study::run_study(wanted);
  }
  const std::string json = study::to_json(result);
  OwedFiles owed;
  for (const study::Experiment& experiment : result.experiments)
    owed.attempt([&] { write::write_text(folder / (experiment.name + ".csv"), study::to_csv(experiment)); });
  owed.attempt([&] { write::write_text(folder / "study.json", json); });
  owed.attempt([&] { write::write_text(folder / "study.md", study::to_markdown(result)); });
  owed.attempt([&] { study::draw_charts(result, folder); });
  if (!options.csv.empty())
    owed.attempt([&] {
      write::write_text(options.csv, result.experiments.size() == 1 ? study::to_csv(result.experiments.front())
                                                                    : study::to_csv(result));
    });
  if (const std::string reason = render::unavailable_reason(); !reason.empty())
    note("warning: no charts are drawn: {}\n", reason);
  if (options.scene.json)
    put(stdout, json);
  else
    say("{}open   {}, charts beside it\n", study::to_text(result), (folder / "study.md").string());
  for (const std::string& why : owed.missing()) note("error: {}\n", why);
  return owed.missing().empty() ? ExitCode::ok : ExitCode::files;
}

}  // namespace gaussdrift::cli
