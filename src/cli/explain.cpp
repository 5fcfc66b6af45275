// gaussdrift explain: the keys of the case file, and the words that go with them.
#include "input/explain.hpp"
#include "base/text_file.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <fstream>

#include "base/printable.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "expression/foreign_names.hpp"
#include "input/effect_rules.hpp"
#include "input/foreign_keys.hpp"
#include "input/markdown.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::cli {

namespace {

struct ExplainOptions {
  std::string word;             // empty: all keys
  bool schema = false;          // the JSON schema instead
  std::filesystem::path guide;  // --markdown; docs/cases.md, whose generated parts are written anew
  bool json = false;
};

/// Tables and keys.
std::vector<std::string> words_to_explain() {
  std::vector<std::string> words = input::table_paths();
  for (const std::string& key : input::key_paths()) words.push_back(key);
  return words;
}

void declare(OptionList& options, ExplainOptions& given) {
  const Option word =
      options
          .add("key", given.word, "KEY",
               "a key, table, field, shape, function, value or symbol (n_g, alpha_j). Without it, all keys")
          .offers(words_to_explain);
  Option schema = options.flag("--schema", given.schema, "the JSON schema of a case");
  options.json(given.json);
  options.add("--markdown", given.guide, "FILE", "write the generated parts of docs/cases.md (FILE) anew")
      .excludes(word)
      .excludes(schema);
  schema.excludes(word);
}

/// Replaces what stands between "<!-- mark: begin" and "<!-- mark: end -->".
void replace_part(std::string& guide, const std::filesystem::path& file, const std::string& mark,
                  const std::string& generated) {
  const std::size_t begin = guide.find("<!-- " + mark + ": begin"), end = guide.find("<!-- " + mark + ": end -->");
  if (begin == std::string::npos || end == std::string::npos || end < begin)
    throw InputError(
        fmt::format("{} has no lines \"<!-- {}: begin -->\" and \"<!-- {}: end -->\"", file.string(), mark, mark));
  const std::size_t first = guide.find('\n', begin) + 1;
  guide.replace(first, end - first, generated);
}

void write_guide(const std::filesystem::path& file) {
  std::string guide = base::read_text_file(file, "a guide", std::size_t{1} << 26);
  replace_part(guide, file, "keys", fmt::format("\n{}\n", input::registry_markdown()));
  replace_part(guide, file, "functions", fmt::format("\n{}\n", input::functions_markdown()));
  replace_part(guide, file, "effects", fmt::format("\n{}\n", input::effects_markdown()));
  write::write_text(file, guide);
}

/// The answer to the word if it is known from other programs; else the word that was probably meant.
std::string not_known(const std::string& word) {
  const std::string text =
      fmt::format("{} is no key, table, field, shape, function, method or symbol", base::in_quotes(word, 60));
  if (const input::ForeignKey* foreign = input::find_foreign_key(word))
    return fmt::format("{}; {}", text, foreign->answer);
  if (const auto instead = expression::instead_of_function(word); !instead.empty())
    return fmt::format("{}; {}", text, instead);
  const auto near = input::suggest_word(word);
  return text + (near ? fmt::format("; did you mean \"{}\"?", *near) : "") +
         "; gaussdrift explain shows the keys, and docs/glossary.md explains other words";
}

ExitCode explain(const ExplainOptions& options) {
  if (!options.guide.empty()) {
    write_guide(options.guide);
  } else if (options.schema) {
    say("{}", input::schema_json());
  } else if (options.word.empty()) {
    say("{}", options.json ? input::keys_json() : input::overview_text(columns_of(stdout)));
  } else {
    const auto found = input::explain(options.word);
    if (found.empty()) throw CommandLineError(not_known(options.word));
    say("{}", options.json ? input::to_json(options.word, found) : input::to_text(found, columns_of(stdout)));
  }
  return ExitCode::ok;
}

}  // namespace

Verb explain_verb() {
  return make_verb<ExplainOptions>(
      "explain", "tell what a key of the case file means: type, default, range, unit, symbol", declare, explain);
}

}  // namespace gaussdrift::cli
