#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "cli/verbs.hpp"
#include "input/read_case.hpp"

namespace gaussdrift::cli {

namespace {

constexpr int exit_code(ExitCode code) { return static_cast<int>(code); }

void add_case_options(CLI::App& verb, CaseOptions& options) {
  verb.add_option("case", options.file, "case file (TOML), see docs/cases.md")->required()->type_name("CASE");
  verb.add_option("--set", options.overrides, "set a key of the case, as in --set time.step=0.01; repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb.add_option("--threads", options.threads, "threads to use; all by default")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  verb.add_flag("--json", options.json, "results as JSON on standard output");
}

ExitCode dispatch(int argc, char** argv) {
  CLI::App app("Smoothed-particle advection: carries blobs through a velocity field and draws their density.",
               "gaussdrift");
  app.set_version_flag("--version", "gaussdrift " GAUSSDRIFT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 ok, 1 internal error, 2 command line, 3 input invalid, 4 numerical failure, 5 a check failed, 6 "
      "files.\n"
      "Start with: gaussdrift run cases/rotating_cone.toml");

  RunOptions run_options;
  CLI::App* run_verb = app.add_subcommand("run", "run a case: files, pictures and numbers in output/<name>/");
  add_case_options(*run_verb, run_options.scene);
  run_verb->add_option("--out", run_options.folder, "folder for the results; output/<name> by default")
      ->type_name("DIR");
  run_verb->add_flag("--force", run_options.force, "replace an earlier run in that folder");

  CaseOptions check_options;
  CLI::App* check_verb =
      app.add_subcommand("check", "validate a case, describe it and predict what it costs, without running it");
  add_case_options(*check_verb, check_options);

  std::string table;
  int threads = 0;
  bool json = false;
  CLI::App* reproduce_verb =
      app.add_subcommand("reproduce", "compute a published table again, beside the published numbers");
  reproduce_verb->add_option("table", table, "what to reproduce (none: a list)")->type_name("TABLE");
  reproduce_verb->add_option("--threads", threads, "threads to use; all by default")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  reproduce_verb->add_flag("--json", json, "results as JSON on standard output");

  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked);
    return ExitCode::ok;
  } catch (const CLI::ParseError& error) {
    throw CommandLineError(fmt::format("{}; gaussdrift --help shows the verbs and their options", error.what()));
  }
  if (run_verb->parsed()) return run(run_options);
  if (check_verb->parsed()) return check(check_options);
  return reproduce(table, threads, json);
}

}  // namespace

int main_verbs(int argc, char** argv) {
  try {
    return exit_code(dispatch(argc, argv));
  } catch (const input::CaseError& error) {  // laid out already
    fmt::print(stderr, "{}\n", error.what());
    return exit_code(error.code());
  } catch (const Error& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    fmt::print(
        stderr,
        "error: out of memory; lower particles.per_axis or evaluate.per_axis (gaussdrift check predicts the memory)\n");
    return exit_code(ExitCode::input);
  } catch (const std::exception& error) {
    fmt::print(stderr, "internal error: {}\n", error.what());
    return exit_code(ExitCode::internal);
  }
}

}  // namespace gaussdrift::cli
