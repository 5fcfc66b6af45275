// The program: its verbs, its command line, and its exit codes.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <new>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "cli/short_memory.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "cli/wrong_words.hpp"
#include "gaussdrift/read_case.hpp"
#include "write/vtk_library.hpp"

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

std::string typed(int argc, char** argv) {
  std::string command;
  for (int i = 0; i < argc; ++i) command += (i ? " " : "") + quoted(argv[i]);
  return command;
}

/// In the order of --help.
std::vector<Verb> all_verbs(const std::string& command) {
  return {new_verb(),    run_verb(command), resume_verb(command), check_verb(), study_verb(),     report_verb(),
          render_verb(), compare_verb(),    doctor_verb(),        sum_verb(),   reproduce_verb(), explain_verb()};
}

ExitCode dispatch(int argc, char** argv) {
  CLI::App app(
      "Moves a density with a flow that you prescribe, by smoothed particles, and says how accurate the result is.",
      "gaussdrift");
  app.set_version_flag("--version", "gaussdrift " GAUSSDRIFT_VERSION);
  app.require_subcommand(1);
  app.footer(
      "Exit codes: 0 ok, 1 internal error, 2 wrong command line, 3 wrong case or table, 4 numerical failure, 5 a check "
      "failed, 6 files, 7 stopped by "
      "--stop-after; 130, 143, 129 stopped by a signal.\n"
      "First steps: gaussdrift new rotating_cone, then gaussdrift run rotating_cone.toml");
  const std::vector<Verb> verbs = all_verbs(typed(argc, argv));
  for (const Verb& verb : verbs) {
    OptionList options(*app.add_subcommand(verb.name, verb.meaning));
    verb.declare(options);
  }
  if (argc > 1 && argv[1][0] != '-' &&
      std::none_of(verbs.begin(), verbs.end(), [&](const Verb& verb) { return verb.name == argv[1]; }))
    throw CommandLineError(unknown_verb(app, argv[1]));
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
  return std::find_if(verbs.begin(), verbs.end(), [&](const Verb& verb) { return app.got_subcommand(verb.name); })
      ->run();
}

}  // namespace

int main_verbs(int argc, char** argv) {
  try {
    write::prepare_vtk();
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
    return exit_code(out_of_memory());
  } catch (const std::exception& error) {
    note("internal error: {}\n", error.what());
    return exit_code(ExitCode::internal);
  }
}

}  // namespace gaussdrift::cli
