// The program: its verbs and its command line, on one rank or several.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/shell_word.hpp"
#include "cli/ending.hpp"
#include "cli/launcher.hpp"
#include "cli/rank_threads.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "cli/wrong_words.hpp"
#include "gaussdrift/error.hpp"
#include "write/vtk_library.hpp"

namespace gaussdrift::cli {

namespace {

std::string typed(int argc, char** argv) {
  std::string command;
  for (int i = 0; i < argc; ++i) command += (i ? " " : "") + base::shell_word(argv[i]);
  return command;
}

/// In the order of --help.
std::vector<Verb> all_verbs(const std::string& command) {
  return {new_verb(),    run_verb(command), resume_verb(command), check_verb(), study_verb(),     report_verb(),
          render_verb(), compare_verb(),    doctor_verb(),        sum_verb(),   reproduce_verb(), explain_verb()};
}

/// What the command line asks for: a verb, or an answer that is there already.
struct Asked {
  std::optional<Verb> verb;
  std::string answer;
};

Asked parse(int argc, char** argv) {
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
    return {.verb = {}, .answer = answer.str()};
  } catch (const CLI::ParseError& error) {
    throw CommandLineError(explained(app, error));
  }
  return {.verb = *std::find_if(verbs.begin(), verbs.end(),
                                [&](const Verb& verb) { return app.got_subcommand(verb.name); }),
          .answer = {}};
}

ExitCode carry_out(const Verb& verb, base::Communicator& ranks, bool launched) {
  if (verb.on_ranks == OnRanks::shared) {
    if (launched && ranks.rank() == 0) note("{}\n", ranks_text(ranks));
    return verb.run(ranks);
  }
  ExitCode code = ExitCode::ok;
  ranks.agree_on([&] {
    if (ranks.rank() == 0) code = verb.run(ranks);
  });
  return code;
}

}  // namespace

int main_verbs(int argc, char** argv) {
  const Launcher launcher = find_launcher();
  std::unique_ptr<base::Communicator> ranks;
  try {
    ranks = start_ranks(launcher);
  } catch (const CommandLineError& error) {
    return refuse(launcher, error.what());
  }
  return end_of(*ranks, [&] {
    write::prepare_vtk();
    if (ranks->size() > 1) share_cores(*ranks);
    Asked asked;
    ranks->agree_on([&] { asked = parse(argc, argv); });
    if (asked.verb) return carry_out(*asked.verb, *ranks, launcher.found);
    if (ranks->rank() == 0) put(stdout, asked.answer);
    return ExitCode::ok;
  });
}

}  // namespace gaussdrift::cli
