#include "cli/completions.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

namespace gaussdrift::cli {
namespace {

/// What a value is completed with.
enum class Kind { nothing, words, cases, files, folders };

struct Completion {
  Kind kind = Kind::nothing;
  std::vector<std::string> words = {};
};

Completion completion_of(const OptionWords& option) {
  if (option.offer) return {Kind::words, option.offer()};
  if (option.type == "CASE") return {Kind::cases};
  if (option.type == "DIR") return {option.is_word() ? Kind::files : Kind::folders};  // of `render`, a file will do
  for (const char* file : {"FILE", "DATA", "A", "B"})
    if (option.type == file) return {Kind::files};
  return {};
}

/// In single quotes of a shell; fish has its own rules.
std::string in_apostrophes(const std::string& text, const char* apostrophe = "'\\''") {
  std::string result = "'";
  for (const char c : text) result += c == '\'' ? apostrophe : std::string(1, c);
  return result + "'";
}

const OptionWords* first_word(const VerbWords& verb) {
  const auto word = std::find_if(verb.options.begin(), verb.options.end(),
                                 [](const OptionWords& option) { return option.is_word(); });
  return word == verb.options.end() ? nullptr : &*word;
}

std::vector<std::string> dashed_options(const VerbWords& verb) {
  std::vector<std::string> options;
  for (const OptionWords& option : verb.options)
    if (!option.dashed().empty()) options.push_back(option.dashed());
  return options;
}

std::vector<std::string> verb_names(const ProgramWords& program) {
  std::vector<std::string> names;
  for (const VerbWords& verb : program.verbs) names.push_back(verb.name);
  return names;
}

// --- bash

std::string bash_reply(const Completion& completion) {
  switch (completion.kind) {
    case Kind::words:
      return fmt::format("_gaussdrift_words {}", in_apostrophes(fmt::format("{}", fmt::join(completion.words, " "))));
    case Kind::cases:
      return "_gaussdrift_files '*.toml'";
    case Kind::files:
      return "_gaussdrift_files '*'";
    case Kind::folders:
      return "_gaussdrift_files ''";
    case Kind::nothing:
      return ":";
  }
  return ":";
}

constexpr const char* bash_opening =
    R"(# Completion of gaussdrift for bash. Written by: gaussdrift manual --completions bash
_gaussdrift_words() {
  local candidate
  COMPREPLY=()
  for candidate in $1; do
    [[ $candidate != "$word"* ]] || COMPREPLY+=("$candidate")
  done
  [[ ${#COMPREPLY[@]} != 1 || ${COMPREPLY[0]} != *= ]] || compopt -o nospace 2>/dev/null
}

# Folders, and files of the pattern.
_gaussdrift_files() {
  local path
  COMPREPLY=()
  compopt -o filenames 2>/dev/null
  while IFS= read -r path; do
    # shellcheck disable=SC2053  # a pattern
    if [[ -d $path || ${path##*/} == $1 ]]; then COMPREPLY+=("$path"); fi
  done < <(compgen -f -- "$word")
}

_gaussdrift() {
  local word=${COMP_WORDS[COMP_CWORD]} verb=${COMP_WORDS[1]} before=${COMP_WORDS[COMP_CWORD - 1]}
)";

std::string bash(const ProgramWords& program) {
  std::string values, options, words;
  for (const VerbWords& verb : program.verbs) {
    for (const OptionWords& option : verb.options)
      if (!option.dashed().empty() && !option.type.empty() && !option.value_optional)
        values +=
            fmt::format("    '{} {}') {}; return ;;\n", verb.name, option.dashed(), bash_reply(completion_of(option)));
    options += fmt::format("      {}) _gaussdrift_words {} ;;\n", verb.name,
                           in_apostrophes(fmt::format("{}", fmt::join(dashed_options(verb), " "))));
    if (const OptionWords* word = first_word(verb))
      words += fmt::format("    {}) {} ;;\n", verb.name, bash_reply(completion_of(*word)));
  }
  return fmt::format(
      "{}  if ((COMP_CWORD == 1)); then\n    _gaussdrift_words '{} --help --version'\n    return\n  fi\n"
      "  case \"$verb $before\" in\n{}  esac\n"
      "  if [[ $word == -* ]]; then\n    case $verb in\n{}    esac\n    return\n  fi\n"
      "  case $verb in\n{}  esac\n}}\ncomplete -F _gaussdrift gaussdrift\n",
      bash_opening, fmt::join(verb_names(program), " "), values, options, words);
}

// --- zsh

/// Of a specification of _arguments: what would end a part of it is escaped.
std::string zsh_safe(const std::string& text) {
  std::string safe;
  for (const char c : text)
    safe += std::string("[]:\\").find(c) == std::string::npos ? std::string(1, c) : std::string{'\\', c};
  return safe;
}

std::string zsh_action(const Completion& completion) {
  switch (completion.kind) {
    case Kind::words: {
      std::string words;
      for (const std::string& word : completion.words) words += (words.empty() ? "" : " ") + zsh_safe(word);
      return "(" + words + ")";
    }
    case Kind::cases:
      return "_files -g \"*.toml\"";
    case Kind::files:
      return "_files";
    case Kind::folders:
      return "_files -/";
    case Kind::nothing:
      return " ";
  }
  return " ";
}

std::string zsh_specification(const OptionWords& option, int& place) {
  const std::string value = fmt::format("{}:{}", zsh_safe(option.type), zsh_action(completion_of(option)));
  if (option.is_word()) return in_apostrophes(fmt::format("{}:{}{}", ++place, option.required ? "" : ":", value));
  std::string text = fmt::format("{}{}[{}]", option.repeatable ? "*" : "", option.name, zsh_safe(option.meaning));
  if (!option.type.empty()) text += (option.value_optional ? "::" : ":") + value;
  return in_apostrophes(text);
}

std::string zsh(const ProgramWords& program) {
  std::string verbs, cases;
  for (const VerbWords& verb : program.verbs) {
    verbs += "    " + in_apostrophes(fmt::format("{}:{}", verb.name, zsh_safe(verb.meaning))) + "\n";
    cases += fmt::format("    {}) _arguments", verb.name);
    int place = 0;
    for (const OptionWords& option : verb.options) cases += " \\\n      " + zsh_specification(option, place);
    cases += " ;;\n";
  }
  return fmt::format(
      "#compdef gaussdrift\n# Completion of gaussdrift for zsh. Written by: gaussdrift manual --completions zsh\n"
      "_gaussdrift() {{\n  local -a verbs\n  verbs=(\n{}  )\n"
      "  if ((CURRENT == 2)); then\n    _describe -t commands command verbs\n"
      "    _arguments '--help[show all commands]' '--version[tell the version]'\n    return\n  fi\n"
      "  local verb=$words[2]\n  shift words\n  ((CURRENT--))\n  case $verb in\n{}  esac\n}}\n"
      "if [[ $funcstack[1] == _gaussdrift ]]; then _gaussdrift \"$@\"; else compdef _gaussdrift gaussdrift; fi\n",
      verbs, cases);
}

// --- fish

std::string fish_quoted(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '\\' ? "\\\\" : std::string(1, c);
  return in_apostrophes(safe, "\\'");
}

/// What `complete` is told about a value: no files unless they are wanted.
std::string fish_value(const Completion& completion, bool of_option) {
  const std::string no_files = of_option ? " -x" : " -f";
  switch (completion.kind) {
    case Kind::words:
      return no_files + " -a " + fish_quoted(fmt::format("{}", fmt::join(completion.words, " ")));
    case Kind::cases:
      return no_files + " -a '(__fish_complete_suffix .toml)'";
    case Kind::files:
      return of_option ? " -r -F" : " -F";
    case Kind::folders:
      return no_files + " -a '(__fish_complete_directories)'";
    case Kind::nothing:
      return no_files;
  }
  return no_files;
}

std::string fish(const ProgramWords& program) {
  std::string text = fmt::format(
      "# Completion of gaussdrift for fish. Written by: gaussdrift manual --completions fish\n"
      "complete -c gaussdrift -f\n"
      "complete -c gaussdrift -n __fish_use_subcommand -l help -d 'show all commands'\n"
      "complete -c gaussdrift -n __fish_use_subcommand -l version -d 'tell the version'\n");
  for (const VerbWords& verb : program.verbs) {
    const std::string after = fmt::format("complete -c gaussdrift -n '__fish_seen_subcommand_from {}'", verb.name);
    text += fmt::format("complete -c gaussdrift -n __fish_use_subcommand -a {} -d {}\n", verb.name,
                        fish_quoted(verb.meaning));
    for (const OptionWords& option : verb.options) {
      const Completion completion = completion_of(option);
      if (option.is_word() && completion.kind != Kind::nothing) text += after + fish_value(completion, false) + "\n";
      if (option.dashed().empty()) continue;
      text += fmt::format("{} -l {} -d {}", after, option.dashed().substr(2), fish_quoted(option.meaning));
      if (!option.type.empty() && !option.value_optional) text += fish_value(completion, true);
      text += "\n";
    }
  }
  return text;
}

struct Shell {
  std::string name;
  std::string (*script)(const ProgramWords&);
};
const Shell all_shells[] = {{"bash", bash}, {"zsh", zsh}, {"fish", fish}};

}  // namespace

std::vector<std::string> shells() {
  std::vector<std::string> names;
  for (const Shell& shell : all_shells) names.push_back(shell.name);
  return names;
}

std::string completions(const ProgramWords& program, const std::string& shell) {
  for (const Shell& known : all_shells)
    if (known.name == shell) return known.script(program);
  throw std::logic_error("no completions for " + shell);
}

}  // namespace gaussdrift::cli
