// gaussdrift manual: the manual page, and completions for shells. Installing writes them to where man and shells look.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "cli/command_line.hpp"
#include "cli/completions.hpp"
#include "cli/manual_page.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"

namespace gaussdrift::cli {

namespace {

struct ManualOptions {
  std::string shell;  // empty: the manual page
  std::function<std::vector<Verb>()> all_verbs = {};
};

void declare(OptionList& options, ManualOptions& given) {
  options
      .add("--completions", given.shell, "SHELL",
           fmt::format("completions of the command line for this shell instead: {}", fmt::join(shells(), ", ")))
      .offers(shells);
}

ExitCode manual(const ManualOptions& options) {
  const ProgramWords program = words_of(options.all_verbs());
  const std::vector<std::string> known = shells();
  if (options.shell.empty())
    say("{}", manual_page(program));
  else if (std::find(known.begin(), known.end(), options.shell) == known.end())
    throw CommandLineError(
        fmt::format("there are no completions for \"{}\", but for {}", options.shell, fmt::join(known, ", ")));
  else
    say("{}", completions(program, options.shell));
  return ExitCode::ok;
}

}  // namespace

Verb manual_verb(std::function<std::vector<Verb>()> all_verbs) {
  return make_verb<ManualOptions>("manual", "print the manual page for man(1), or completions for a shell", declare,
                                  manual, {.shell = {}, .all_verbs = std::move(all_verbs)});
}

}  // namespace gaussdrift::cli
