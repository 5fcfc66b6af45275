// Explains a word of a case file: a key, a table, a named field or shape, a function, a value of a choice, or a symbol
// of the thesis. All of it is told from the registry.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::input {

struct Fact {
  std::string label, value;  // "default", "2"
};

/// One thing that a word means.
struct Explanation {
  std::string kind;   // "key", "table", "field", "shape", "function", "method", "quantity"
  std::string name;   // "particles.per_axis"
  std::string title;  // one line: its meaning
  std::vector<Fact> facts;
};

/// Everything that `word` means, the most exact meanings first; nothing if it is unknown. A key may be written with its
/// table or without, a symbol in letters (alpha_j, n_g), in Greek or in TeX.
std::vector<Explanation> explain(std::string_view word);
/// The known word that is nearest to an unknown one.
std::optional<std::string> suggest_word(std::string_view word);

/// "particles.per_axis", ...: every key that stands in a table; and the names of the tables.
std::vector<std::string> key_paths();
std::vector<std::string> table_paths();

/// Every table with its keys. Texts stand beside their labels in lines of at most `columns` characters, where there is
/// room for that; 0: each in one line.
std::string overview_text(std::size_t columns = 0);
std::string to_text(const std::vector<Explanation>& explanations, std::size_t columns = 0);
std::string to_json(std::string_view word, const std::vector<Explanation>& explanations);

/// A JSON schema (draft 2020-12) of the case format, for editors that complete and check TOML. What the schema accepts
/// may still be refused by the reader, which also knows what goes together.
std::string schema_json();
/// All keys as JSON, in the order of the registry.
std::string keys_json();

}  // namespace gaussdrift::input
