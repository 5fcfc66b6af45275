// The program: its verbs and its command line, on one rank or several.
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "base/shell_word.hpp"
#include "cli/command_line.hpp"
#include "cli/ending.hpp"
#include "cli/launcher.hpp"
#include "cli/rank_threads.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

namespace {

std::string typed(int argc, char** argv) {
  std::string command;
  for (int i = 0; i < argc; ++i) command += (i ? " " : "") + base::shell_word(argv[i]);
  return command;
}

/// In the order of --help.
std::vector<Verb> all_verbs(const std::string& command) {
  return {new_verb(),       run_verb(command), resume_verb(command),
          check_verb(),     study_verb(),      report_verb(),
          render_verb(),    compare_verb(),    field_verb(),
          doctor_verb(),    fit_verb(),        sum_verb(),
          reproduce_verb(), explain_verb(),    manual_verb([command] { return all_verbs(command); })};
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
    if (ranks->size() > 1) share_cores(*ranks);
    const std::vector<Verb> verbs = all_verbs(typed(argc, argv));
    CommandLine asked{};
    ranks->agree_on([&] { asked = parse(argc, argv, verbs); });
    if (asked.verb) return carry_out(*asked.verb, *ranks, launcher.found);
    if (ranks->rank() == 0) put(stdout, asked.answer);
    return ExitCode::ok;
  });
}

}  // namespace gaussdrift::cli
