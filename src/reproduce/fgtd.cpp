#include "reproduce/fgtd.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/stopwatch.hpp"
#include "gaussdrift/error.hpp"
#include "reproduce/fgtd_tables.hpp"
#include "reproduce/published.hpp"

namespace gaussdrift::reproduce {

namespace {

struct Group {
  std::vector<std::string> numbers;  // of the tables that are measured together
  std::vector<Table> (*compute)(const FgtdOptions&);
};

const std::vector<Group>& groups(TableSet set) {
  static const std::vector<Group> divergence{{{"6.1"}, field_table}, {{"6.2"}, divergence_table}};
  static const std::vector<Group> all{{{"3.2", "3.3"}, [](const FgtdOptions&) { return analytic_tables(); }},
                                      {{"3.4", "3.5"}, [](const FgtdOptions&) { return parameter_tables(); }},
                                      {{"4.1", "4.2"}, point_number_tables},
                                      {{"4.3"}, preparation_table},
                                      {{"4.4"}, break_even_table},
                                      {{"4.5"}, dimension_table},
                                      {{"4.6"}, width_table},
                                      {{"4.7"}, spacing_table},
                                      {{"4.8"}, point_set_table},
                                      {{"4.9"}, level_table}};
  return set == TableSet::fgtd ? all : divergence;
}

// Rows and columns of a table know where in the published one they are printed.
void quote(Table& table) {
  const PublishedTable published("schroeder-table-" + table.number);
  for (Row& row : table.rows)
    for (std::size_t i = 0; i < row.entries.size(); ++i) {
      const Column& column = table.columns[i];
      if (column.printed.empty()) continue;
      const auto number = published.number(row.printed, column.printed);
      if (!number) continue;
      row.entries[i].published = *number * column.unit;
      row.entries[i].last_digit = published.last_digit(row.printed, column.printed) * column.unit;
    }
}

void count_agreement(const Table& table, FgtdReproduction& result) {
  for (const Row& row : table.rows)
    for (std::size_t i = 0; i < row.entries.size(); ++i) {
      const Column& column = table.columns[i];
      const Entry& entry = row.entries[i];
      const std::string place = fmt::format("Table {}, {}, {}", table.number, row.name, column.name);
      if (!entry.kept) result.disagreements.push_back(place + ": automatic breaks its promise");
      if (!is_compared(column, entry)) continue;
      ++result.compared;
      const auto kind = std::find(comparisons.begin(), comparisons.end(), comparison_of(column, entry));
      ++result.by_kind[static_cast<std::size_t>(kind - comparisons.begin())];
      if (!agrees(column, entry))
        result.disagreements.push_back(
            fmt::format("{}: {:g}, published {:g}", place, *entry.computed, *entry.published));
      else if (off(column, entry))
        result.off.push_back({fmt::format("{}: {}, published {}", place, short_power(*entry.computed, 3),
                                          short_power(*entry.published, 1)),
                              column.why_off});
    }
}

}  // namespace

int power_of_ten(double x) {
  if (!(x > 0)) return x == 0 ? -400 : 400;  // below every double, and a NaN above
  if (std::isinf(x)) return 400;
  return static_cast<int>(std::floor(std::log10(x) + 1e-9));
}

std::string to_string(Comparison comparison) {
  constexpr std::array names{"nothing", "arithmetic", "equal digits", "order of magnitude",
                             "at most the published error"};
  return names[static_cast<std::size_t>(comparison)];
}

Comparison comparison_of(const Column& column, const Entry& entry) {
  return entry.comparison.value_or(column.comparison);
}

bool is_compared(const Column& column, const Entry& entry) {
  return entry.published && entry.computed && comparison_of(column, entry) != Comparison::none;
}

bool agrees(const Column& column, const Entry& entry) {
  if (!entry.kept) return false;
  if (!is_compared(column, entry)) return true;
  const double then = *entry.published, now = *entry.computed;
  const int power = power_of_ten(then);
  switch (comparison_of(column, entry)) {
    case Comparison::arithmetic:
      if (column.quantity == Quantity::count) return now == then;
      return std::abs(power_of_ten(now) - power) <= column.decades;
    case Comparison::digits:
      return std::abs(now - then) <= 0.5 * (1 + 1e-6) * entry.last_digit;  // 1e-6: the halves that are rounded
    case Comparison::order:
      // Some powers are printed rounded, 9.1e1 as 1e2, others cut off, 6.5e3 as 1e3.
      return now >= std::pow(10, power - 0.5) && power_of_ten(now / error_slack) <= power;
    default:
      return power_of_ten(now / error_slack) <= power + column.decades;
  }
}

bool off(const Column& column, const Entry& entry) {
  if (!is_compared(column, entry) || column.quantity == Quantity::count) return false;
  const int away = power_of_ten(*entry.computed) - power_of_ten(*entry.published);
  return away > 0 || (away < 0 && comparison_of(column, entry) == Comparison::arithmetic);
}

std::vector<std::string> table_numbers(TableSet set) {
  std::vector<std::string> all;
  for (const Group& group : groups(set)) all.insert(all.end(), group.numbers.begin(), group.numbers.end());
  return all;
}

FgtdReproduction reproduce_fgtd(const FgtdOptions& options, const std::function<void(const std::string&)>& progress) {
  const auto numbers = table_numbers(options.set);
  if (!options.table.empty() && std::find(numbers.begin(), numbers.end(), options.table) == numbers.end())
    throw CommandLineError(
        fmt::format("there is no table \"{}\"; there are {}", options.table, fmt::join(numbers, ", ")));
  const base::Stopwatch watch;
  FgtdReproduction result;
  result.source = fmt::format("Schroeder 2006, Tables {}", fmt::join(numbers, ", "));
  result.threads = options.threads > 0 ? options.threads : 1;
  for (const Group& group : groups(options.set)) {
    const auto wanted = [&](const std::string& number) { return options.table.empty() || options.table == number; };
    if (std::none_of(group.numbers.begin(), group.numbers.end(), wanted)) continue;
    if (progress) progress(fmt::format("Table {}", fmt::join(group.numbers, ", ")));
    for (Table& table : group.compute(options)) {
      if (!wanted(table.number)) continue;
      quote(table);
      count_agreement(table, result);
      result.tables.push_back(std::move(table));
    }
  }
  result.seconds = watch.seconds();
  return result;
}

}  // namespace gaussdrift::reproduce
