// gaussdrift run: the case is run, its errors are explained, and everything is written before the first word.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/footprint.hpp"
#include "base/parallel.hpp"
#include "base/printable.hpp"
#include "cli/asked_case.hpp"
#include "cli/look_back.hpp"
#include "cli/output_name.hpp"
#include "cli/owed_files.hpp"
#include "cli/progress.hpp"
#include "cli/run_words.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/read_case.hpp"
#include "input/data_files.hpp"
#include "render/picture.hpp"
#include "render/picture_series.hpp"
#include "render/styles.hpp"
#include "report/page.hpp"
#include "write/atomic_file.hpp"
#include "write/output_files.hpp"
#include "write/provenance.hpp"
#include "write/run_folder.hpp"
#include "write/series_table.hpp"
#include "write/summary.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct RunOptions {
  CaseOptions case_options;
  std::filesystem::path folder{};  // --out; empty: output/<case name>
  bool force = false;
  std::string command{};  // as it was typed, for provenance.json
};

void declare(OptionList& options, RunOptions& given) {
  declare_case(options, given.case_options);
  options.add("--out", given.folder, "DIR", "folder for the results; output/<name> by default");
  options.flag("--force", given.force, "replace an earlier run in that folder");
}

void add_observers(Simulation& simulation, const Case& spec, const fs::path& folder) {
  simulation.observe(
      write::series_table(folder, spec.domain.dimension, spec.reference.kind != ReferenceSpec::Kind::none));
  for (const OutputFile& file : spec.output.files)
    simulation.observe(write::file_series(write::find_output_file(file.name), folder));
  if (const auto& images = spec.output.images; !images.empty()) {
    if (const std::string reason = render::unavailable_reason(); !reason.empty())
      note("warning: no pictures are drawn: {}\n", reason);
    else
      simulation.observe(render::picture_series(folder, images, spec.title.empty() ? spec.name : spec.title));
  }
}

/// Lines for the end of the run: what the page does without.
std::string write_page(const fs::path& folder, const Case& spec, OwedFiles& owed) {
  std::string without;
  try {
    const report::ReportFiles page = report::write_report(folder, !spec.output.images.empty());
    for (const std::string& what : page.left_out) without += fmt::format("page   without {}\n", what);
    const bool there =
        std::find(page.written.begin(), page.written.end(), folder / "report.html") != page.written.end();
    for (const std::string& why : page.failed)
      owed.miss(fmt::format("{}: {}; gaussdrift report {} makes it later",
                            there ? "the page about this run is not complete" : "there is no page about this run", why,
                            folder.string()));
  } catch (const std::exception& error) {  // what was computed stands in the other files, and its checks count
    owed.miss(fmt::format("there is no page about this run: {}; gaussdrift report {} makes it later", error.what(),
                          folder.string()));
  }
  return without;
}

/// Data files are named as seen from the run's folder. The hash has their bytes and bare names: where they lie is of no
/// interest to the result.
std::string provenance_of(const Case& spec, const fs::path& folder, const RunOptions& options) {
  std::vector<write::DataFile> data;
  for (const fs::path& file : input::data_files(spec))
    data.push_back({input::seen_from(folder, file).generic_string(), file});
  return write::provenance_json(spec, case_text(input::with_bare_names(spec)), data, options.command,
                                base::resolve_threads(options.case_options.threads));
}

/// Bytes that the run writes at least: the exact density may stand beside the other.
double least_disk(const Case& spec, std::size_t particles) {
  const Domain& domain = spec.domain;
  const Lattice grid = spec.evaluate.spacing > 0
                           ? make_lattice_with_spacing(domain.dimension, domain.min, domain.max, spec.evaluate.spacing)
                           : make_lattice(domain.dimension, domain.min, domain.max, spec.evaluate.per_axis);
  return accuracy::disk_of_run(
      spec, {.particles = static_cast<double>(particles), .grid_points = static_cast<double>(grid.size())});
}

class Run {
 public:
  explicit Run(const RunOptions& options)
      : options_(options),
        asked_(read(options.case_options)),
        spec_(settled(asked_, options.case_options)),
        folder_(options.folder.empty() ? fs::path("output") / spec_.name : options.folder) {}

  void simulate() {
    refuse_what_does_not_fit(spec_, threads());
    Simulation simulation(spec_, threads());
    simulation.prepare();  // what cannot begin must not cost an earlier run
    const std::string provenance = provenance_of(spec_, folder_, options_);
    own_folder_.emplace(folder_, spec_,
                        write::RunFolderOptions{.force = options_.force,
                                                .bytes = least_disk(spec_, simulation.particles().size()),
                                                .picture_styles = render::style_names()});
    write::write_run_inputs(folder_, spec_, case_text(spec_, folder_));
    write::write_text(folder_ / "provenance.json", provenance);
    add_observers(simulation, spec_, folder_);
    if (looks_back(spec_)) simulation.observe(std::make_unique<accuracy::LastFrame>(last_, spec_.output.times.back()));
    simulation.observe(own_folder_->watch());
    ProgressLine line;
    simulation.on_progress([&](const Progress& progress) {
      line.show(progress);
      return true;
    });
    summary_ = simulation.run();
  }

  void explain_errors() {
    warnings_ = warnings_of(spec_, summary_);
    budget_ = look_back(spec_, summary_, last_, more_, warnings_, threads());
    if (const auto target = asked_.accuracy.target; target && !summary_.frames.empty()) {
      const auto& error = summary_.frames.back().second.error;
      const bool known = error && std::isfinite(error->linf);
      more_["accuracy"] = {{"target", *target},
                           {"achieved", known ? nlohmann::ordered_json(error->linf) : nlohmann::ordered_json()},
                           {"met", known && error->linf <= *target}};
      if (const std::string& why = summary_.frames.back().second.no_norms; !why.empty())
        more_["accuracy"]["not_known"] = why;
    }
    if (!warnings_.empty()) more_["warnings"] = warnings_;
  }

  /// Every file before the first word: a terminal that takes no text costs no result.
  void write() {
    summary_text_ = write::summary_json(spec_, summary_, more_);
    std::string without;
    if (owed_.attempt([&] { write::write_text(folder_ / "summary.json", summary_text_); }) && spec_.output.report)
      without = write_page(folder_, spec_, owed_);
    ending_ = ending_text(spec_, summary_, budget_, asked_.accuracy.target, folder_) + without;
    std::string log;
    for (const std::string& warning : warnings_) log += "warning: " + warning + "\n";
    for (const std::string& why : owed_.missing()) log += "error: " + why + "\n";
    owed_.attempt([&] { write::write_text(folder_ / "log.txt", base::printable_lines(log + ending_)); });
    owed_.attempt([&] { own_folder_->complete(); });
  }

  /// After a failure: where the run is that this one was to replace.
  void tell_what_is_kept() const {
    if (own_folder_ && own_folder_->keeps_earlier())
      note("the earlier run is whole in {}; it is replaced when another run in its place has an output\n",
           (folder_ / "earlier").string());
  }

  ExitCode report() const {
    for (const std::string& warning : warnings_) note("warning: {}\n", warning);
    put(stdout, options_.case_options.json ? summary_text_ : ending_);
    bool failed = false;
    for (const CheckResult& result : summary_.checks) {
      if (result.passed) continue;
      failed = true;
      note("check failed: {}\n", result.text);
    }
    for (const std::string& why : owed_.missing()) note("error: {}\n", why);
    return failed ? ExitCode::check : owed_.missing().empty() ? ExitCode::ok : ExitCode::files;
  }

 private:
  int threads() const { return options_.case_options.threads; }

  const RunOptions& options_;
  const Case asked_, spec_;  // spec_: with the settings that the target asked for
  const fs::path folder_;
  accuracy::LastFrame::Kept last_;
  RunSummary summary_;
  std::optional<accuracy::Budget> budget_;
  std::vector<std::string> warnings_;
  nlohmann::ordered_json more_;  // members of summary.json beside those of the run
  std::string summary_text_, ending_;
  OwedFiles owed_;
  std::optional<write::RunFolder> own_folder_;
};

ExitCode run(const RunOptions& options) {
  check_folder_name(options.folder,
                    "a run leaves a folder with ParaView files (density.pvd), pictures (PNG) and tables (CSV)");
  Run run(options);
  try {
    run.simulate();
  } catch (...) {
    run.tell_what_is_kept();
    throw;
  }
  run.explain_errors();
  run.write();
  return run.report();
}

}  // namespace

Verb run_verb(const std::string& typed) {
  return make_verb<RunOptions>("run", "run a case: files, pictures and numbers in output/<name>/", declare, run,
                               {.case_options = {}, .command = typed});
}

}  // namespace gaussdrift::cli
