#include "cli/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>
#include <filesystem>
#include <iterator>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "cli/options.hpp"
#include "cli/wrong_words.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

Option& Option::required() {
  option_->required();
  words_->required = true;
  return *this;
}

Option& Option::repeatable() {
  option_->allow_extra_args(false);
  words_->repeatable = true;
  return *this;
}

Option& Option::separated_by(char separator) {
  option_->delimiter(separator);
  return *this;
}

Option& Option::value_optional() {
  option_->expected(0, 1)->default_str("true");
  words_->value_optional = true;
  return *this;
}

Option& Option::within(int least, int most) {
  option_->check(CLI::Range(least, most));
  words_->range = fmt::format("{} to {}", least, most);
  return *this;
}

Option& Option::within(double least, double most) {
  option_->check(CLI::Range(least, most));
  words_->range = fmt::format("{} to {}", least, most);
  return *this;
}

Option& Option::not_negative() {
  option_->check(CLI::NonNegativeNumber);
  words_->range = "at least 0";
  return *this;
}

Option& Option::excludes(const Option& other) {
  option_->excludes(other.option_);
  return *this;
}

Option& Option::offers(std::function<std::vector<std::string>()> words) {
  words_->offer = std::move(words);
  return *this;
}

template <class Value>
Option OptionList::add(const std::string& name, Value& value, const std::string& type, const std::string& meaning) {
  words_.push_back({.name = name, .type = type, .meaning = meaning});
  return {*verb_.add_option(name, value, meaning)->type_name(type), words_.back()};
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
  words_.push_back({.name = name, .type = {}, .meaning = meaning});
  return {*verb_.add_flag(name, value, meaning), words_.back()};
}

void OptionList::threads(int& value) {
  add("--threads", value, "N", "number of threads; all by default").within(1, 1024);
}

void OptionList::json(bool& value, const std::string& meaning) { flag("--json", value, meaning); }

namespace {

const std::string purpose =
    "Moves a density with a flow that you prescribe, by smoothed particles, and says how accurate the result is.";

constexpr ExitMeaning exit_meanings[] = {
    {"0", "ok"},
    {"1", "internal error"},
    {"2", "wrong command line"},
    {"3", "wrong case or table"},
    {"4", "numerical failure"},
    {"5", "a check failed"},
    {"6", "files"},
    {"7", "stopped by --stop-after"},
    {"130, 143, 129", "stopped by a signal"},
};

std::string exit_codes_in_a_line() {
  std::string line;
  for (const auto& [code, meaning] : exit_meanings)
    line += fmt::format("{}{} {}", line.empty() ? "" : code.size() > 1 ? "; " : ", ", code, meaning);
  return line;
}

/// The answer to `gaussdrift` alone.
std::string first_steps() {
  return fmt::format(
      "gaussdrift {}. {}\n\n"
      "First steps:\n"
      "  gaussdrift new rotating_cone        writes an example, rotating_cone.toml\n"
      "  gaussdrift run rotating_cone.toml   runs it; then open output/rotating_cone/report.html in a browser\n\n"
      "A scene of your own:\n"
      "  gaussdrift new --blank 2d           writes scene.toml, which runs and is to be changed; or 3d\n"
      "  gaussdrift check scene.toml         says what a run of it will be like, and cost\n"
      "  gaussdrift explain particles        explains a table of the file, or a key\n\n"
      "gaussdrift new lists the examples, gaussdrift --help all commands, gaussdrift doctor tries this machine.\n",
      GAUSSDRIFT_VERSION, purpose);
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

/// Declares the options of all verbs, and tells what they have said.
std::vector<VerbWords> declare(CLI::App& app, const std::vector<Verb>& verbs) {
  std::vector<VerbWords> all;
  for (const Verb& verb : verbs) {
    std::deque<OptionWords>& words = all.emplace_back(VerbWords{verb.name, verb.meaning, {}}).options;
    OptionList options(*app.add_subcommand(verb.name, verb.meaning), words);
    verb.declare(options);
    words.push_back({.name = "--help", .type = {}, .meaning = "show these options and exit"});
  }
  return all;
}

}  // namespace

ProgramWords words_of(const std::vector<Verb>& verbs) {
  CLI::App app;
  return {purpose, GAUSSDRIFT_VERSION, std::vector<ExitMeaning>(std::begin(exit_meanings), std::end(exit_meanings)),
          declare(app, verbs)};
}

CommandLine parse(int argc, char** argv, const std::vector<Verb>& verbs) {
  CLI::App app(purpose, "gaussdrift");
  app.set_version_flag("--version", "gaussdrift " GAUSSDRIFT_VERSION);
  app.require_subcommand(1);
  app.footer(
      fmt::format("Exit codes: {}.\nFirst steps: gaussdrift new rotating_cone, then gaussdrift run rotating_cone.toml",
                  exit_codes_in_a_line()));
  const std::vector<VerbWords> words = declare(app, verbs);
  if (argc == 1) return {.verb = nullptr, .answer = first_steps()};
  if (argv[1][0] != '-' &&
      std::none_of(verbs.begin(), verbs.end(), [&](const Verb& verb) { return verb.name == argv[1]; }))
    throw CommandLineError(unknown_verb(words, argv[1]));
  try {
    app.parse(argc, argv);
  } catch (const CLI::Success& asked) {  // --help, --version
    std::ostringstream answer;
    answer.exceptions(std::ios::badbit);  // a stream keeps silent where there is no memory
    app.exit(asked, answer, answer);
    return {.verb = nullptr, .answer = answer.str()};
  } catch (const CLI::ParseError& error) {
    throw CommandLineError(explained(words, unread(app, error)));
  }
  return {.verb = &*std::find_if(verbs.begin(), verbs.end(),
                                 [&](const Verb& verb) { return app.got_subcommand(verb.name); }),
          .answer = {}};
}

}  // namespace gaussdrift::cli
