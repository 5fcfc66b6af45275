#include "cli/wrong_words.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "base/printable.hpp"
#include "base/suggest.hpp"

namespace gaussdrift::cli {
namespace {

using base::in_quotes;

/// Verbs of other programs.
constexpr std::pair<std::string_view, std::string_view> verbs_elsewhere[] = {
    {"simulate", "run"}, {"start", "run"},       {"exec", "run"},     {"plot", "render"},    {"draw", "render"},
    {"view", "render"},  {"show", "render"},     {"diff", "compare"}, {"validate", "check"}, {"lint", "check"},
    {"init", "new"},     {"create", "new"},      {"list", "new"},     {"info", "explain"},   {"man", "explain"},
    {"test", "doctor"},  {"benchmark", "study"}, {"bench", "study"},  {"help", "--help"},    {"version", "--version"},
};

std::vector<std::string> options_of(const CLI::App& verb) {
  std::vector<std::string> names;
  for (const CLI::Option* option : verb.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

bool has(const CLI::App& verb, const std::string& option) {
  const std::vector<std::string> all = options_of(verb);
  return std::find(all.begin(), all.end(), option) != all.end();
}

/// The only option that begins like this, or the nearest one.
std::optional<std::string> meant(const CLI::App& verb, const std::string& option) {
  const std::vector<std::string> all = options_of(verb);
  std::vector<std::string> longer;
  std::copy_if(all.begin(), all.end(), std::back_inserter(longer),
               [&](const std::string& name) { return name.rfind(option, 0) == 0; });
  if (option.size() > 3 && longer.size() == 1) return longer.front();
  return base::suggest(option, all);
}

std::string unknown_option(const CLI::App& app, const CLI::App& verb, const std::string& word) {
  const std::size_t equals = word.find('=');
  const std::string option = word.substr(0, equals);
  const std::string text = fmt::format("{} has no option {}", verb.get_name(), in_quotes(option));
  if (option.rfind("--", 0) == 0 && option.find('.') != std::string::npos && has(verb, "--set"))
    return text + fmt::format("; keys of the case are set by --set {}", base::printable(word.substr(2)));
  if (option.size() > 1 && option[1] != '-' && has(verb, "-" + option))
    return text + fmt::format(", did you mean -{}?", option);
  if (const auto near = meant(verb, option)) return text + fmt::format(", did you mean {}?", *near);
  std::vector<std::string> homes;
  for (const CLI::App* other : app.get_subcommands({}))
    if (other != &verb && has(*other, option)) homes.push_back(other->get_name());
  if (!homes.empty()) return text + fmt::format("; it belongs to {}", fmt::join(homes, ", "));
  return text;
}

}  // namespace

std::string unknown_verb(const CLI::App& app, const std::string& word) {
  std::vector<std::string> verbs;
  for (const CLI::App* verb : app.get_subcommands({})) verbs.push_back(verb->get_name());
  std::string text = fmt::format("there is no command {}", in_quotes(word, 60));
  std::string remedy;
  if (const auto near = base::suggest(word, verbs)) remedy = fmt::format("; did you mean \"{}\"?", *near);
  for (const auto& [elsewhere, here] : verbs_elsewhere)
    if (word == elsewhere) remedy = fmt::format("; did you mean \"{}\"?", here);
  if (word.size() > 5 && word.substr(word.size() - 5) == ".toml")
    remedy = fmt::format("; to run the case write: gaussdrift run {}", base::printable(word));
  return text + remedy + " (gaussdrift --help lists the commands)";
}

std::string explained(const CLI::App& app, const CLI::ParseError& error) {
  const std::vector<const CLI::App*> parsed = app.get_subcommands([](const CLI::App* verb) { return verb->parsed(); });
  if (parsed.empty()) return fmt::format("{}; gaussdrift --help lists the commands", error.what());
  const CLI::App& verb = *parsed.front();
  const std::string help = fmt::format("; gaussdrift {} --help shows its options", verb.get_name());
  // Before what is missing: an option that is misspelt is missing too.
  const std::vector<std::string> extra = verb.remaining();
  for (const std::string& word : extra)
    if (word.size() > 1 && word[0] == '-' && word != "--") return unknown_option(app, verb, word) + help;
  if (!extra.empty() && error.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))
    return fmt::format("{} is one word too many{}", in_quotes(extra.front(), 60), help);
  return base::printable(error.what()) + help;
}

}  // namespace gaussdrift::cli
