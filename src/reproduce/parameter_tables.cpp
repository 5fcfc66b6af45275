// Tables 3.2 to 3.5: what the parameters of `hermite` cost and how accurate they are.
#include <fmt/format.h>

#include <string>
#include <vector>

#include "reproduce/fgtd_entries.hpp"
#include "reproduce/fgtd_tables.hpp"
#include "reproduce/point_sets.hpp"

namespace gaussdrift::reproduce {

namespace {

// Tables 3.2 to 3.5 have rows nu and columns p5, ..., p12.
struct TermsTable {
  PublishedTable published;
  Table table;

  TermsTable(const std::string& number, const std::string& title, const std::string& what, Column of_all)
      : published("schroeder-table-" + number), table{number, title, what, {}, {}} {
    for (std::size_t i = 1; i < published.columns().size(); ++i) {
      of_all.printed = published.columns()[i];
      of_all.name = "p=" + of_all.printed.substr(1);
      table.columns.push_back(of_all);
    }
    for (std::size_t row = 0; row < published.rows(); ++row)
      table.rows.push_back({"nu = " + published.row_name(row), row, {}, {}});
  }
  int nu(std::size_t row) const { return static_cast<int>(row_number(published, row)); }
  int terms(std::size_t column) const { return std::stoi(table.columns[column].printed.substr(1)); }

  template <class Number>
  void fill(const Number& number) {
    for (std::size_t row = 0; row < table.rows.size(); ++row)
      for (std::size_t column = 0; column < table.columns.size(); ++column)
        table.rows[row].entries.push_back({number(nu(row), terms(column)), {}});
  }
};

}  // namespace

std::vector<Table> analytic_tables() {
  TermsTable cost("3.2", "cost p^d N + nu^d p^d M", "d = 3, N = M = 1; nothing is summed",
                  {.quantity = Quantity::count, .comparison = Comparison::arithmetic, .digits = 0});
  TermsTable bound("3.3", "bound (3.5)", "d = 3, every box, r = 1/nu (sigma = 2), alpha = 0, Q = 1; nothing is summed",
                   {.comparison = Comparison::arithmetic});
  cost.fill([](int nu, int p) { return fgtd::hermite_cost(3, p, boxes_of(3, nu), 1, 1); });
  bound.fill([](int nu, int p) { return fgtd::hermite_bound<3>(1.0 / nu, p, all_boxes, {}).value(); });
  return {cost.table, bound.table};
}

std::vector<Table> parameter_tables() {
  constexpr std::size_t count = 12;
  const std::string taken = fmt::format(
      "d = 3, sigma = 2, alpha = 0, every box. The thesis does not state the number of points; here {} Halton points "
      "with weights scaled to Q = 1",
      count);
  TermsTable error("3.4", "absolute error", taken, {.comparison = Comparison::order, .automatic = true});
  TermsTable time("3.5", "microseconds to prepare and evaluate at all points",
                  taken + ". Published as hundredths of a second, which is plausible for 12 points. One thread",
                  {.quantity = Quantity::seconds, .digits = 3, .automatic = true, .unit = 1e4});
  Problem<3> problem{halton_points<3>(count), halton_weights(count, 3), 2.0, {}};
  problem.weights /= problem.weights.sum();
  const MeasuredSum<3> sum(problem, count, count, 1);
  for (std::size_t row = 0; row < error.table.rows.size(); ++row)
    for (std::size_t i = 0; i < error.table.columns.size(); ++i) {
      const Measurement hermite = sum.hermite(error.nu(row), error.terms(i), all_boxes);
      const Measurement automatic = sum.automatic(hermite.absolute);
      error.table.rows[row].entries.push_back(absolute_errors(hermite, automatic));
      time.table.rows[row].entries.push_back({1e6 * seconds_for(hermite, count), 1e6 * seconds_for(automatic, count)});
    }
  return {error.table, time.table};
}

}  // namespace gaussdrift::reproduce
