#include "input/table_columns.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/number.hpp"
#include "base/printable.hpp"
#include "base/suggest.hpp"
#include "gaussdrift/error.hpp"
#include "input/column_names.hpp"

namespace gaussdrift::input {

namespace {

using base::in_quotes;

constexpr std::size_t largest_dimension = 4;  // of fgtd

class Choice {
 public:
  Choice(const TableColumns& table, const WantedColumns& wanted, const RefuseColumn& refuse)
      : table_(table), wanted_(wanted), refuse_(refuse) {}

  ChosenColumns choose() {
    if (wanted_.table == WantedColumns::Table::exactly) {
      choose_exactly();
      return std::move(chosen_);
    }
    choose_weight();
    if (wanted_.coordinates.empty())
      choose_others();
    else
      choose_named();
    return std::move(chosen_);
  }

 private:
  using Kind = WantedColumns::Table;

  [[noreturn]] void refuse(std::optional<std::size_t> column, const std::string& what) const {
    refuse_(column, what);
    throw Error(ExitCode::internal, "a table was not refused: " + what);
  }
  const char* word() const { return wanted_.table == Kind::sources ? "sources" : "targets"; }

  std::optional<std::size_t> find(const std::string& name) const {
    if (const auto same = std::find(table_.names.begin(), table_.names.end(), name); same != table_.names.end())
      return static_cast<std::size_t>(same - table_.names.begin());
    if (!is_column_number(name)) return std::nullopt;
    const auto number = base::read_number<std::size_t>(name);
    if (!number || *number < 1 || *number > table_.names.size())
      refuse({}, fmt::format("there is no column {}; {} columns are there, counted from 1", base::printable(name),
                             table_.names.size()));
    return *number - 1;
  }

  [[noreturn]] void refuse_missing(const std::string& name) const {
    if (!table_.named)
      refuse({}, fmt::format("there is no column {}: its columns have no names; give their numbers, as in --columns "
                             "1,2 --weight 3",
                             in_quotes(name)));
    const auto meant = base::suggest(name, table_.names);
    refuse({}, fmt::format("there is no column {} among {}{}", in_quotes(name), listed(table_.names),
                           meant ? fmt::format("; is {} meant?", in_quotes(*meant)) : ""));
  }

  void choose_exactly() {
    const std::vector<std::string>& names = wanted_.coordinates;
    const std::string rule = fmt::format("the columns must be {}", listed(names, ","));
    if (!table_.named) {  // by their order
      if (table_.names.size() != names.size())
        refuse({}, fmt::format("{} columns are there; {}", table_.names.size(), rule));
      for (std::size_t k = 0; k < names.size(); ++k) chosen_.coordinates.push_back(k);
      return;
    }
    if (!table_.places && table_.names.size() >= names.size())
      for (std::size_t k = 0; k < table_.names.size(); ++k)
        if (std::find(names.begin(), names.end(), table_.names[k]) == names.end())
          refuse(k, fmt::format("column {} is not one of those that are wanted; {}: remove it",
                                in_quotes(table_.names[k]), rule));
    for (const std::string& name : names) {
      const auto found = std::find(table_.names.begin(), table_.names.end(), name);
      if (found == table_.names.end())
        refuse({}, fmt::format("there is no column {} among {}; {}", in_quotes(name), listed(table_.names), rule));
      chosen_.coordinates.push_back(static_cast<std::size_t>(found - table_.names.begin()));
    }
  }

  void choose_weight() {
    const std::string name = wanted_.weight_name();
    if (wanted_.table == Kind::targets) {
      if (!wanted_.coordinates.empty() || is_column_number(name) || table_.places) return;
      if (const auto column = find(name))
        refuse(column, fmt::format("targets have coordinates only; remove the column {}, or name the coordinates by "
                                   "--columns",
                                   in_quotes(name)));
      return;
    }
    chosen_.weight = find(name);
    if (chosen_.weight || (wanted_.weight_may_lack && wanted_.weight.empty())) return;
    if (!wanted_.weight.empty()) refuse_missing(name);
    if (!table_.named)
      refuse({}, "its columns have no names; say by number which is the weight, as in --columns 1,2 --weight 3");
    const auto meant = base::suggest(name, table_.names);
    refuse({}, fmt::format("there is no column \"weight\" among {}; {}", listed(table_.names),
                           meant ? fmt::format("is {} meant? --weight {} takes it", in_quotes(*meant),
                                               base::printable(base::shortened(*meant, 24)))
                                 : std::string("--weight names another one; or add one, with 1 in every line if all "
                                               "sources count the same")));
  }

  void choose_named() {
    for (const std::string& name : wanted_.coordinates) {
      const auto column = find(name);
      if (!column) refuse_missing(name);
      if (column == chosen_.weight)
        refuse(column, fmt::format("the column {} is not a coordinate of sources", in_quotes(table_.names[*column])));
      if (std::find(chosen_.coordinates.begin(), chosen_.coordinates.end(), *column) != chosen_.coordinates.end())
        refuse(column, fmt::format("the column {} is named twice as a coordinate", in_quotes(table_.names[*column])));
      chosen_.coordinates.push_back(*column);
    }
  }

  /// May the column be no coordinate, by what its name says?
  bool is_doubtful(std::size_t column) const {
    if (!table_.named) return false;
    const std::string& name = table_.names[column];
    return names_no_coordinate(name) || (wanted_.table == Kind::sources && name == "weight");
  }

  /// All columns but the weight.
  void choose_others() {
    std::vector<std::string> trusted, all;
    std::optional<std::size_t> doubted;
    const std::size_t count = table_.places.value_or(table_.names.size());
    for (std::size_t k = 0; k < count; ++k) {
      if (k == chosen_.weight) continue;
      chosen_.coordinates.push_back(k);
      all.push_back(table_.names[k]);
      if (!is_doubtful(k))
        trusted.push_back(table_.names[k]);
      else if (!doubted)
        doubted = k;
    }
    if (doubted) {
      const std::string name = in_quotes(table_.names[*doubted]), every = listed(all, ",");
      refuse(doubted, trusted.empty()
                          ? fmt::format("is the column {} a coordinate? Say so by --columns {}", name, every)
                          : fmt::format("is the column {} a coordinate? --columns {} takes the others, --columns {} "
                                        "takes all",
                                        name, listed(trusted, ","), every));
    }
    if (chosen_.coordinates.empty())
      refuse({}, fmt::format("there are no coordinates; {} have 1 to {}", word(), largest_dimension));
    if (chosen_.coordinates.size() > largest_dimension) {
      const std::size_t fifth = chosen_.coordinates[largest_dimension];
      refuse(fifth, fmt::format("{} would be coordinate {}; {} have 1 to {}: name them, as in --columns {}",
                                in_quotes(table_.names[fifth]), largest_dimension + 1, word(), largest_dimension,
                                table_.named ? "x,y" : "1,2"));
    }
  }

  const TableColumns& table_;
  const WantedColumns& wanted_;
  const RefuseColumn& refuse_;
  ChosenColumns chosen_;
};

}  // namespace

bool WantedColumns::by_number() const {
  const bool weight_is = is_column_number(weight) || (weight.empty() && (table == Table::targets || weight_may_lack));
  return table != Table::exactly && weight_is && !(coordinates.empty() && weight.empty()) &&
         std::all_of(coordinates.begin(), coordinates.end(), is_column_number);
}

std::string WantedColumns::example() const {
  if (table == Table::exactly) return listed(coordinates, ",");
  return table == Table::sources && !weight_may_lack ? "x,y,weight" : "x,y";
}

bool is_column_number(const std::string& name) {
  return !name.empty() && name.find_first_not_of("0123456789") == std::string::npos;
}

ChosenColumns choose_columns(const TableColumns& table, const WantedColumns& wanted, const RefuseColumn& refuse) {
  return Choice(table, wanted, refuse).choose();
}

}  // namespace gaussdrift::input
