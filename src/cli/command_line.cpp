#include "cli/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "cli/options.hpp"
#include "cli/wrong_words.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

Option& Option::required() {
  option_->required();
  return *this;
}

Option& Option::repeatable() {
  option_->allow_extra_args(false);
  return *this;
}

Option& Option::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::value_optional() {
  option_->expected(0, 1)->default_str("true");
  return *this;
}

Option& Option::within(int least, int most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::within(double least, double most) {
  option_->check(CLI::Range(least, most));
  return *this;
}

Option& Option::not_negative() {
  option_->check(CLI::NonNegativeNumber);
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

template <class Value>
Option OptionList::add(const std::string& name, Value& value, const std::string& type, const std::string& meaning) {
  return Option(*verb_.add_option(name, value, meaning)->type_name(type));
}
template Option OptionList::add(const std::string&, std::string&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::filesystem::path&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, int&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, double&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::optional<double>&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::optional<int>&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::vector<std::string>&, const std::string&, const std::string&);
template Option OptionList::add(const std::string&, std::vector<double>&, const std::string&, const std::string&);

Option OptionList::flag(const std::string& name, bool& value, const std::string& meaning) {
  return Option(*verb_.add_flag(name, value, meaning));
}

void OptionList::threads(int& value) {
  add("--threads", value, "N", "number of threads; all by default").within(1, 1024);
}

void OptionList::json(bool& value, const std::string& meaning) { flag("--json", value, meaning); }

namespace {

VerbWords words_of(const CLI::App& verb) {
  VerbWords words{verb.get_name(), {}};
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) words.options.push_back("--" + name);
  return words;
}

std::vector<VerbWords> all_words(const CLI::App& app) {
  std::vector<VerbWords> all;
  for (const CLI::App* verb : app.get_subcommands({})) all.push_back(words_of(*verb));
  return all;
}

Unread unread(const CLI::App& app, const CLI::ParseError& error) {
  Unread words{.message = error.what()};
  const std::vector<const CLI::App*> parsed = app.get_subcommands([](const CLI::App* verb) { return verb->parsed(); });
  if (parsed.empty()) return words;
  words.verb = parsed.front()->get_name();
  words.extra = parsed.front()->remaining();
  words.too_many = error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError);
  return words;
}

}  // namespace

CommandLine parse(int argc, char** argv, const std::vector<Verb>& verbs) {
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
  for (const Verb& verb : verbs) {
    OptionList options(*app.add_subcommand(verb.name, verb.meaning));
    verb.declare(options);
  }
  if (argc > 1 && argv[1][0] != '-' &&
      std::none_of(verbs.begin(), verbs.end(), [&](const Verb& verb) { return verb.name == argv[1]; }))
    throw CommandLineError(unknown_verb(all_words(app), argv[1]));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream answer;
    answer.exceptions(std::ios::badbit);  // a stream keeps silent where there is no memory
    app.exit(asked, answer, answer);
    return {.verb = nullptr, .answer = answer.str()};
  } catch (const CLI::ParseError& error) {
    throw CommandLineError(explained(all_words(app), unread(app, error)));
  }
  return {.verb = &*std::find_if(verbs.begin(), verbs.end(),
                                 [&](const Verb& verb) { return app.got_subcommand(verb.name); }),
          .answer = {}};
}

}  // namespace gaussdrift::cli
