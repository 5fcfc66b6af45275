// Which columns of a table are read: by name, by number, or by what they are not.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gaussdrift::input {

/// What a table is to have.
struct WantedColumns {
  enum class Table { sources, targets, exactly } table = Table::sources;
  std::vector<std::string> coordinates = {};  // names, or numbers from 1; none: all but the weight
  std::string weight = {};                    // name or number; empty: "weight"
  bool weight_may_lack = false;               // all points count the same then

  std::string weight_name() const { return weight.empty() ? "weight" : weight; }
  /// Are columns named, and all of them by number? Then the table needs no line of names.
  bool by_number() const;
  /// "x,y,weight", or what must be there.
  std::string example() const;
};

/// The columns that a table has.
struct TableColumns {
  std::vector<std::string> names;  // where there are none, "1", "2", ...
  bool named = true;
  std::optional<std::size_t> places = {};  // so many first columns are the places of points by themselves
};

struct ChosenColumns {
  std::vector<std::size_t> coordinates;  // columns from 0
  std::optional<std::size_t> weight;
};

/// Refuses a table for what is wrong with this column (from 0), or with all of them. Does not return.
using RefuseColumn = std::function<void(std::optional<std::size_t> column, const std::string& what)>;

/// `name` is no doubtful one, or was asked for. Everything else goes to `refuse`.
ChosenColumns choose_columns(const TableColumns& table, const WantedColumns& wanted, const RefuseColumn& refuse);

/// Is it a number of a column as users write it: "1", "12"?
bool is_column_number(const std::string& name);

}  // namespace gaussdrift::input
