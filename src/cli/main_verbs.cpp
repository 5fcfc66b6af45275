#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/output_name.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "cli/wrong_words.hpp"
#include "gaussdrift/read_case.hpp"
#include "read/grid_file.hpp"

namespace gaussdrift::cli {

namespace {

constexpr int exit_code(ExitCode code) { return static_cast<int>(code); }

/// The command line in a form that a shell reads again: words with unusual characters stand in single quotes.
std::string quoted(const std::string& word) {
  constexpr std::string_view plain = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_@%+=:,./-";
  if (!word.empty() && word.find_first_not_of(plain) == std::string::npos) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

void add_case_options(CLI::App& verb, CaseOptions& options) {
  verb.add_option("case", options.file, "case file (TOML), see docs/cases.md")->required()->type_name("CASE");
  verb.add_option("--set", options.overrides, "set a key of the case: --set time.step=0.01. Repeatable")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  verb.add_option("--accuracy", options.accuracy,
                  "error that you accept at the end, relative to the largest density. Settings are chosen for it")
      ->type_name("X");
  verb.add_option("--threads", options.threads, "number of threads; all by default")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  verb.add_flag("--json", options.json, "results as JSON on standard output");
}

void add_sum_options(CLI::App& verb, SumOptions& options) {
  verb.add_option("--sources", options.sources, "table of sources (CSV): coordinates and a column weight")
      ->required()
      ->type_name("FILE");
  CLI::Option* targets = verb.add_option("--targets", options.targets, "table of targets. By default the sources");
  targets->type_name("FILE");
  verb.add_option("--columns", options.columns,
                  "the columns that are coordinates: --columns x,y. By default all but weight")
      ->type_name("NAME,...");
  verb.add_option("--grid", options.grid, "a grid of targets: --grid=-1:1:200,0:1:100. Its first axis runs fastest")
      ->type_name("LOW:HIGH:COUNT,...")
      ->excludes(targets);
  verb.add_option("--sigma", options.sigma, "of the Gaussian exp(-sigma r^2)")->type_name("X");
  verb.add_option("--derivative", options.derivatives,
                  "a derivative of the Gaussians: --derivative 0,1,2. Repeatable. By default the plain sum")
      ->type_name("A1,A2,...")
      ->allow_extra_args(false);
  verb.add_option("--tolerance", options.tolerance,
                  "error of every term (docs/fgtd.md, docs/farfield.md); 1e-6 by default")
      ->type_name("X");
  verb.add_option("--method", options.method,
                  "auto (the default), or a method of the library. A wrong name is answered with the list")
      ->type_name("NAME");
  verb.add_option("--seconds", options.seconds,
                  "refuse a sum that is predicted to take longer; 300 by default for a method that you name")
      ->type_name("S");
  verb.add_option("--kernel", options.kernel,
                  "gauss (the default), coulomb (2D, 3D) or log (1D, 2D). The last two give potential and field")
      ->type_name("NAME");
  verb.add_option("--out", options.out, "file for the values. By default, or as -, standard output")->type_name("FILE");
  verb.add_option("--threads", options.threads, "number of threads; all by default")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  verb.add_flag("--json", options.json, "what was chosen and what it cost, as JSON on standard output. Needs --out");
}

ExitCode dispatch(int argc, char** argv) {
  CLI::App app(
      "Moves a density with a flow that you prescribe, by smoothed particles, and says how accurate the result is.",
      "gaussdrift");
  app.set_version_flag("--version", "gaussdrift " GAUSSDRIFT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 ok, 1 internal error, 2 wrong command line, 3 wrong case or table, 4 numerical failure, 5 a check "
      "failed, 6 files.\n"
      "First steps: gaussdrift new rotating_cone, then gaussdrift run rotating_cone.toml");

  NewOptions new_options;
  CLI::App* new_verb = app.add_subcommand("new", "list the built-in cases, or write one to start from");
  new_verb->add_option("name", new_options.name, "the case to write. Without it, a list")->type_name("NAME");
  new_verb->add_option("--out", new_options.folder, "folder for the file; this one by default")->type_name("DIR");
  new_verb->add_flag("--force", new_options.force, "replace a file of that name");
  new_verb->add_flag("--json", new_options.json, "results as JSON on standard output");

  RunOptions run_options;
  CLI::App* run_verb = app.add_subcommand("run", "run a case: files, pictures and numbers in output/<name>/");
  add_case_options(*run_verb, run_options.scene);
  run_verb->add_option("--out", run_options.folder, "folder for the results; output/<name> by default")
      ->type_name("DIR");
  run_verb->add_flag("--force", run_options.force, "replace an earlier run in that folder");

  CaseOptions check_options;
  CLI::App* check_verb = app.add_subcommand("check", "describe a case and predict what it costs, without running it");
  add_case_options(*check_verb, check_options);

  StudyVerbOptions study_options;
  CLI::App* study_verb =
      app.add_subcommand("study", "measure what accuracy costs in time: tables, charts, a conclusion");
  add_case_options(*study_verb, study_options.scene);
  study_verb
      ->add_option(
          "--vary", study_options.vary,
          "run with these values of a key: --vary time.step=0.1,0.05. Repeatable: then every combination. Without it, "
          "the standard studies")
      ->type_name("KEY=A,B,...")
      ->allow_extra_args(false);
  study_verb
      ->add_option("--repeats", study_options.repeats,
                   "how often a cheap run is timed. The fastest counts; 3 by default")
      ->check(CLI::Range(1, 100))
      ->type_name("N");
  study_verb
      ->add_option("--seconds", study_options.seconds, "about how long the standard studies may take; 90 by default")
      ->check(CLI::Range(1, 100000))
      ->type_name("S");
  study_verb->add_option("--out", study_options.folder, "folder for tables and charts; output/study_<case> by default")
      ->type_name("DIR");
  study_verb->add_option("--csv", study_options.csv, "also write all results as one table")->type_name("FILE");
  study_verb->add_flag("--force", study_options.force, "replace an earlier study in that folder");

  ReportOptions report_options;
  CLI::App* report_verb =
      app.add_subcommand("report", "make the page of a run again: report.html, report.json, summary.png");
  report_verb->add_option("folder", report_options.folder, "folder of a run")->required()->type_name("DIR");
  report_verb->add_flag("--json", report_options.json, "results as JSON on standard output");

  RenderOptions render_options;
  CLI::App* render_verb = app.add_subcommand("render", "draw the densities of a run again, without running it");
  render_verb->add_option("folder", render_options.folder, "folder of a run, or a .vti")->required()->type_name("DIR");
  render_verb
      ->add_option("--style", render_options.style, "surface, contour, heatmap; slices, projection, isosurface; error")
      ->type_name("NAME");
  render_verb->add_option("--field", render_options.field, "rho (the default), rho_exact or error")->type_name("NAME");
  render_verb->add_option("--times", render_options.times, "only these output times")
      ->delimiter(',')
      ->type_name("T,...");
  render_verb->add_option("--out", render_options.out, "folder for the pictures; images/ of the run by default")
      ->type_name("DIR");
  render_verb->add_flag("--json", render_options.json, "results as JSON on standard output");

  CompareOptions compare_options;
  CLI::App* compare_verb =
      app.add_subcommand("compare", "compare two results: norms of the difference, relative to the second");
  compare_verb->add_option("first", compare_options.first, "folder of a run, or a .vti")->required()->type_name("A");
  compare_verb->add_option("second", compare_options.second, "what it is compared with")->required()->type_name("B");
  compare_verb
      ->add_option("--tolerance", compare_options.tolerance, "exit code 5 if the largest difference is above this")
      ->check(CLI::NonNegativeNumber)
      ->type_name("X");
  compare_verb->add_flag("--json", compare_options.json, "results as JSON on standard output");

  DoctorOptions doctor_options;
  CLI::App* doctor_verb = app.add_subcommand("doctor", "try everything on this machine: a sum, a picture, a file");
  doctor_verb->add_flag("--json", doctor_options.json, "results as JSON on standard output");

  SumOptions sum_options;
  CLI::App* sum_verb = app.add_subcommand("sum", "sum Gaussians, Coulomb charges or logarithms over a table of points");
  add_sum_options(*sum_verb, sum_options);

  ReproduceOptions reproduce_options;
  CLI::App* reproduce_verb =
      app.add_subcommand("reproduce", "compute a published table again, beside the published numbers");
  reproduce_verb->add_option("what", reproduce_options.what, "what to reproduce. Without it, a list")
      ->type_name("WHAT");
  reproduce_verb
      ->add_option("table,--table", reproduce_options.table,
                   "one table of fgtd or divergence, or one figure, such as 4.6. By default all")
      ->type_name("TABLE");
  reproduce_verb
      ->add_option("--out", reproduce_options.folder,
                   "folder for figures or for logkernel; output/figures or output/logkernel by default")
      ->type_name("DIR");
  reproduce_verb->add_flag(
      "--full", reproduce_options.full,
      "fgtd, divergence, coulomb: also the largest rows, and every target compared; figures: 5.3 with the "
      "thesis's steps");
  reproduce_verb->add_option("--threads", reproduce_options.threads, "number of threads; all by default")
      ->check(CLI::Range(1, 1024))
      ->type_name("N");
  reproduce_verb->add_flag("--json", reproduce_options.json, "results as JSON on standard output");

  ExplainOptions explain_options;
  CLI::App* explain_verb =
      app.add_subcommand("explain", "tell what a key of the case file means: type, default, range, unit, symbol");
  CLI::Option* word = explain_verb->add_option("key", explain_options.word,
                                               "a key, table, field, shape, function, value or symbol (n_g, "
                                               "alpha_j). Without it, all keys");
  word->type_name("KEY");
  CLI::Option* schema = explain_verb->add_flag("--schema", explain_options.schema, "the JSON schema of a case");
  explain_verb->add_flag("--json", explain_options.json, "results as JSON on standard output");
  explain_verb
      ->add_option("--markdown", explain_options.guide, "write the generated parts of docs/cases.md (FILE) anew")
      ->type_name("FILE")
      ->excludes(word)
      ->excludes(schema);
  schema->excludes(word);

  if (argc > 1 && argv[1][0] != '-') {
    std::vector<std::string> verbs;
    for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
    if (std::find(verbs.begin(), verbs.end(), argv[1]) == verbs.end())
      throw CommandLineError(unknown_verb(app, argv[1]));
  }
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream answer;
    app.exit(asked, answer, answer);
    put(stdout, answer.str());
    return ExitCode::ok;
  } catch (const CLI::ParseError& error) {
    throw CommandLineError(explained(app, error));
  }
  if (sum_verb->parsed()) check_table_name(sum_options.out);
  constexpr std::string_view results =
      "a run leaves a folder with ParaView files (density.pvd), pictures (PNG) and tables (CSV)";
  check_folder_name(run_options.folder, results);
  check_folder_name(study_options.folder, "a study leaves a folder with tables (CSV) and charts (PNG)");
  check_folder_name(render_options.out, "pictures are written into a folder, as surface_0000.png and so on");
  check_folder_name(reproduce_options.folder, "pictures are written into a folder");
  if (new_verb->parsed()) return new_case(new_options);
  if (explain_verb->parsed()) return explain(explain_options);
  if (run_verb->parsed()) {
    for (int i = 0; i < argc; ++i) run_options.command += (i ? " " : "") + quoted(argv[i]);
    return run(run_options);
  }
  if (report_verb->parsed()) return report(report_options);
  if (render_verb->parsed()) return render(render_options);
  if (compare_verb->parsed()) return compare(compare_options);
  if (doctor_verb->parsed()) return doctor(doctor_options);
  if (check_verb->parsed()) return check(check_options);
  if (study_verb->parsed()) return study(study_options);
  if (sum_verb->parsed()) return sum(sum_options);
  return reproduce(reproduce_options);
}

}  // namespace

int main_verbs(int argc, char** argv) {
  read::silence_vtk();
  try {
    const ExitCode code = dispatch(argc, argv);
    const Delivery delivered = delivery();
    if (delivered == Delivery::lost)
      note("error: standard output cannot be written, so what should stand there is lost\n");
    return exit_code(code == ExitCode::ok && delivered != Delivery::all ? ExitCode::files : code);
  } catch (const CaseError& error) {  // laid out already
    note("{}\n", error.what());
    return exit_code(error.code());
  } catch (const Error& error) {
    note("error: {}\n", error.what());
    return exit_code(error.code());
  } catch (const std::bad_alloc&) {
    note("error: out of memory; lower particles.per_axis or evaluate.per_axis\n");
    return exit_code(ExitCode::input);
  } catch (const std::exception& error) {
    note("internal error: {}\n", error.what());
    return exit_code(ExitCode::internal);
  }
}

}  // namespace gaussdrift::cli
