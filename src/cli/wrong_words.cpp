#include "cli/wrong_words.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
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

std::vector<std::string> options_of(const VerbWords& verb) {
  std::vector<std::string> options;
  for (const OptionWords& words : verb.options)
    if (!words.dashed().empty()) options.push_back(words.dashed());
  return options;
}

bool has(const VerbWords& verb, const std::string& option) {
  const std::vector<std::string> options = options_of(verb);
  return std::find(options.begin(), options.end(), option) != options.end();
}

/// The only option that begins like this, or the nearest one.
std::optional<std::string> meant(const VerbWords& verb, const std::string& option) {
  const std::vector<std::string> options = options_of(verb);
  std::vector<std::string> longer;
  std::copy_if(options.begin(), options.end(), std::back_inserter(longer),
               [&](const std::string& name) { return name.rfind(option, 0) == 0; });
  if (option.size() > 3 && longer.size() == 1) return longer.front();
  return base::suggest(option, options);
}

std::string unknown_option(const std::vector<VerbWords>& verbs, const VerbWords& verb, const std::string& word) {
  const std::size_t equals = word.find('=');
  const std::string option = word.substr(0, equals);
  const std::string text = fmt::format("{} has no option {}", verb.name, in_quotes(option));
  if (option.rfind("--", 0) == 0 && option.find('.') != std::string::npos && has(verb, "--set"))
    return text + fmt::format("; keys of the case are set by --set {}", base::printable(word.substr(2)));
  if (option.size() > 1 && option[1] != '-' && has(verb, "-" + option))
    return text + fmt::format(", did you mean -{}?", option);
  if (const auto near = meant(verb, option)) return text + fmt::format(", did you mean {}?", *near);
  std::vector<std::string> homes;
  for (const VerbWords& other : verbs)
    if (other.name != verb.name && has(other, option)) homes.push_back(other.name);
  if (!homes.empty()) return text + fmt::format("; it belongs to {}", fmt::join(homes, ", "));
  return text;
}

}  // namespace

std::string unknown_verb(const std::vector<VerbWords>& verbs, const std::string& word) {
  std::vector<std::string> names;
  for (const VerbWords& verb : verbs) names.push_back(verb.name);
  std::string text = fmt::format("there is no command {}", in_quotes(word, 60));
  std::string remedy;
  if (const auto near = base::suggest(word, names)) remedy = fmt::format("; did you mean \"{}\"?", *near);
  for (const auto& [elsewhere, here] : verbs_elsewhere)
    if (word == elsewhere) remedy = fmt::format("; did you mean \"{}\"?", here);
  if (word.size() > 5 && word.substr(word.size() - 5) == ".toml")
    remedy = fmt::format("; to run the case write: gaussdrift run {}", base::printable(word));
  return text + remedy + " (gaussdrift --help lists the commands)";
}

std::string explained(const std::vector<VerbWords>& verbs, const Unread& words) {
  const auto verb =
      std::find_if(verbs.begin(), verbs.end(), [&](const VerbWords& one) { return one.name == words.verb; });
  if (verb == verbs.end()) return fmt::format("{}; gaussdrift --help lists the commands", words.message);
  const std::string help = fmt::format("; gaussdrift {} --help shows its options", verb->name);
  // Before what is missing: an option that is misspelt is missing too.
  for (const std::string& word : words.extra)
    if (word.size() > 1 && word[0] == '-' && word != "--") return unknown_option(verbs, *verb, word) + help;
  if (!words.extra.empty() && words.too_many)
    return fmt::format("{} is one word too many{}", in_quotes(words.extra.front(), 60), help);
  return base::printable(words.message) + help;
}

}  // namespace gaussdrift::cli
