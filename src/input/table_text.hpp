// The numbers of a table of text: a line of names, then a line for every row.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "input/points_table.hpp"
#include "input/table_columns.hpp"

namespace gaussdrift::input {

struct TextTable {
  std::vector<std::string> names;  // of the coordinates
  std::vector<double> rows;        // [row][coordinate]
  std::vector<double> weights;     // [row]; empty without a column for them
  RowLines lines;
};

/// Throws InputError, with line and column, for what cannot be read as it stands, and for what would take more than
/// `memory_limit` bytes, the text among them. `name` stands for the file in messages.
TextTable parse_text_table(std::string_view text, const std::string& name, const WantedColumns& wanted,
                           std::size_t memory_limit);

/// The names of the columns of such a table, as far as they can be read; empty if its first line holds numbers.
std::vector<std::string> names_in(std::string_view text);

}  // namespace gaussdrift::input
