// gaussdrift run: the case with the settings that it asks for, in a folder of its own.
#include "cli/asked_case.hpp"
#include "cli/carry_out.hpp"
#include "cli/output_name.hpp"
#include "cli/shared_task.hpp"
#include "cli/stop_request.hpp"
#include "cli/verbs.hpp"

namespace gaussdrift::cli {

namespace {

struct RunOptions {
  CaseOptions case_options;
  std::filesystem::path folder{};  // --out; empty: output/<case name>
  bool force = false;
  std::string stop_after{};  // a length of time; empty: never
  std::string command{};     // as it was typed, for provenance.json
};

void declare(OptionList& options, RunOptions& given) {
  declare_case(options, given.case_options);
  options.add("--out", given.folder, "DIR", "folder for the results; output/<name> by default");
  options.flag("--force", given.force, "replace an earlier run in that folder");
  declare_stop_after(options, given.stop_after);
}

RunTask task_of(const RunOptions& options) {
  check_folder_name(options.folder,
                    "a run leaves a folder with ParaView files (density.pvd), pictures (PNG) and tables (CSV)");
  RunTask task;
  task.stop_after = stop_after_seconds(options.stop_after);
  task.most_memory = most_memory(options.case_options.memory);
  task.asked = read(options.case_options);
  task.spec = settled(task.asked, options.case_options);
  task.folder = options.folder.empty() ? std::filesystem::path("output") / task.spec.name : options.folder;
  task.command = options.command;
  task.force = options.force;
  task.json = options.case_options.json;
  task.threads = options.case_options.threads;
  return task;
}

ExitCode run(const RunOptions& options, base::Communicator& ranks) {
  return carry_out(shared_task(ranks, [&] { return task_of(options); }), ranks);
}

}  // namespace

Verb run_verb(const std::string& typed) {
  return make_shared_verb<RunOptions>("run", "run a case: files, pictures and numbers in output/<name>/", declare, run,
                                      {.case_options = {}, .command = typed});
}

}  // namespace gaussdrift::cli
