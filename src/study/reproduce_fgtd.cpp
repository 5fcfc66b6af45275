#include "study/reproduce_fgtd.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/stopwatch.hpp"
#include "study/fgtd_tables.hpp"

namespace gaussdrift::study {

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
                                      {{"4.8"}, point_set_table}};
  return set == TableSet::fgtd ? all : divergence;
}

bool comparable(const Column& column, const Entry& entry) {
  return entry.published && entry.computed && column.quantity != Quantity::seconds &&
         column.quantity != Quantity::factor;
}

void count_agreement(const Table& table, FgtdReproduction& result) {
  for (const Row& row : table.rows)
    for (std::size_t i = 0; i < row.entries.size(); ++i) {
      const Column& column = table.columns[i];
      const Entry& entry = row.entries[i];
      const std::string place = fmt::format("Table {}, {}, {}", table.number, row.name, column.name);
      if (!entry.kept) result.disagreements.push_back(place + ": automatic breaks its promise");
      if (!comparable(column, entry)) continue;
      ++result.compared;
      const double then = *entry.published, now = *entry.computed;
      const bool exact = column.quantity == Quantity::count;
      if (exact ? now == then : power_of_ten(now) == power_of_ten(then)) ++result.equal;
      if (!exact && power_of_ten(now) < power_of_ten(then)) ++result.better;
      if (!agrees(column, entry))
        result.disagreements.push_back(fmt::format("{}: {:g}, published {:g}", place, now, then));
    }
}

}  // namespace

int power_of_ten(double x) {
  if (!(x > 0)) return x == 0 ? -400 : 400;  // below every double, and a NaN above
  if (std::isinf(x)) return 400;
  return static_cast<int>(std::floor(std::log10(x) + 1e-9));
}

bool agrees(const Column& column, const Entry& entry) {
  if (!entry.kept) return false;
  if (!comparable(column, entry)) return true;
  const double then = *entry.published, now = *entry.computed;
  switch (column.quantity) {
    case Quantity::count:
      return now == then;
    case Quantity::bound:
      return std::abs(power_of_ten(now) - power_of_ten(then)) <= column.decades;
    default:
      return power_of_ten(now / error_slack) <= power_of_ten(then) + column.decades;
  }
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
      count_agreement(table, result);
      result.tables.push_back(std::move(table));
    }
  }
  result.seconds = watch.seconds();
  return result;
}

}  // namespace gaussdrift::study
