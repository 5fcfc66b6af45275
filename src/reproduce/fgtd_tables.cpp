// Tables 4.1 to 4.9: the measurements of chapter 4.
#include "reproduce/fgtd_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "gaussdrift/error.hpp"
#include "reproduce/fgtd_entries.hpp"
#include "reproduce/measured_sum.hpp"
#include "reproduce/point_sets.hpp"
#include "reproduce/published.hpp"

namespace gaussdrift::reproduce {

namespace {

// The two choices of parameters that chapter 4 measures.
struct Parameters {
  int p, nu;
  std::string name() const { return fmt::format("p={} nu={}", p, nu); }
  std::string printed() const { return fmt::format("p{}nu{}", p, nu); }  // in the published tables
};
constexpr Parameters coarse{8, 2}, fine{9, 3};
constexpr std::array<Parameters, 2> both{coarse, fine};

// How many of `points` targets a direct sum over as many sources may have.
std::size_t within_pairs(const FgtdOptions& options, double sources, double targets) {
  return static_cast<std::size_t>(std::clamp(options.most_pairs / sources, 1.0, targets));
}

std::size_t within_terms(const FgtdOptions& options, double terms_a_target, double targets) {
  return static_cast<std::size_t>(std::clamp(options.most_terms / terms_a_target, 1.0, targets));
}

std::string sampled(const FgtdOptions& options) {
  if (std::isinf(options.most_pairs)) return "";
  return fmt::format("; direct sums beyond {:.0e} pairs at a sample of the targets", options.most_pairs);
}

// The conditions of [Sch06, 4.1]: Halton points and weights, sigma = 2, alpha = (0, ..., d-1).
template <int d>
Problem<d> standard_problem(std::size_t count) {
  Problem<d> problem{halton_points<d>(count), halton_weights(count, d), 2.0, {}};
  std::iota(problem.alpha.begin(), problem.alpha.end(), 0);
  return problem;
}

constexpr const char* beyond_the_end = "just beyond the end of the printed power of ten";
constexpr const char* nearest_to_zero =
    "it is the error of the one target where the sum is nearest to 0. The thesis's weights are not known to the digit";

std::string chosen(const Measurement& automatic) {
  return fmt::format("{} {:.0e}", fgtd::to_string(automatic.choice.method), automatic.choice.tolerance);
}

/// Of Tables 4.1 and 4.2.
void add_columns(const Parameters& q, Table& error, Table& time) {
  error.columns.push_back(
      {.name = q.name() + " bound",
       .printed = q.printed() + "_bound",
       .comparison = Comparison::arithmetic,
       .decades = 1,
       .why_off = "(3.5) gives 11.3 Q and 0.0295 Q for the two choices, the thesis says Q 10^1 and Q 10^-2"});
  error.columns.push_back({.name = q.name() + " absolute",
                           .printed = q.printed() + "_absolute",
                           .comparison = Comparison::order,
                           .automatic = true,
                           .why_off = beyond_the_end});
  error.columns.push_back({.name = q.name() + " relative",
                           .printed = q.printed() + "_relative",
                           .comparison = Comparison::at_most,
                           .automatic = true,
                           .decades = 1,
                           .why_off = nearest_to_zero});
  time.columns.push_back({.name = q.name() + " seconds",
                          .printed = "seconds_" + q.printed(),
                          .quantity = Quantity::seconds,
                          .digits = 3,
                          .automatic = true});
  time.columns.push_back({.name = q.name() + " times faster",
                          .printed = "speedup_" + q.printed(),
                          .quantity = Quantity::factor,
                          .digits = 3,
                          .automatic = true});
}

}  // namespace

std::vector<Table> point_number_tables(const FgtdOptions& options) {
  const std::string what = "N = M Halton points, d = 3, sigma = 2, alpha = (0,1,2), every box" + sampled(options);
  Table error{"4.1", "error over the number of points", what, {}, {}};
  Table time{"4.2", "seconds over the number of points", what, {}, {}};
  time.columns.push_back(
      {.name = "direct", .printed = "seconds_brute_force", .quantity = Quantity::seconds, .digits = 3});
  for (const Parameters& q : both) add_columns(q, error, time);
  const PublishedTable published("schroeder-table-4.1");
  for (std::size_t row = 0; row < published.rows(); ++row) {
    const double n = row_number(published, row);
    if (n > options.most_points) continue;
    const Problem<3> problem = standard_problem<3>(static_cast<std::size_t>(n));
    const MeasuredSum<3> sum(problem, within_pairs(options, n, n),
                             within_terms(options, fgtd::hermite_cost(3, fine.p, boxes_of(3, fine.nu), 0, 1), n),
                             timed_threads(options));
    const double direct = n * sum.direct_seconds();
    const std::string name = fmt::format("N = {:.0f}", n);
    Row& error_row = error.rows.emplace_back(Row{name, row, {}, {}});
    Row& time_row = time.rows.emplace_back(Row{name, row, {}, {}});
    time_row.entries.push_back({direct, {}});
    const auto faster = [&](double seconds) { return seconds < direct ? direct / seconds : never; };
    for (std::size_t i = 0; i < both.size(); ++i) {
      const auto [p, nu] = both[i];
      const Measurement hermite = sum.hermite(nu, p, all_boxes), automatic = sum.automatic(hermite.absolute);
      const double bound = fgtd::hermite_bound<3>(1.0 / nu, p, all_boxes, problem.alpha).value() * std::pow(2.0, 1.5);
      error_row.entries.push_back({bound * sum.total_weight(), {}});
      error_row.entries.push_back(absolute_errors(hermite, automatic));
      error_row.entries.push_back(relative_errors(hermite, automatic));
      const double now = seconds_for(hermite, n), third = seconds_for(automatic, n);
      time_row.entries.push_back({now, third});
      time_row.entries.push_back({faster(now), faster(third)});
      time_row.note += (i > 0 ? ", " : "auto: ") + chosen(automatic);
    }
    error_row.note = time_row.note;
  }
  return {error, time};
}

std::vector<Table> preparation_table(const FgtdOptions& options) {
  Table table{"4.3",
              "seconds to prepare N sources, and to evaluate one target",
              "Halton points, d = 3, sigma = 2, alpha = (0,1,2), every box. auto plans for as many targets as sources",
              {},
              {}};
  for (const char* part : {"prepare", "evaluate"})
    for (const Parameters& q : both)
      table.columns.push_back({.name = fmt::format("{} {}", part, q.name()),
                               .printed = fmt::format("{}_{}", part, q.printed()),
                               .quantity = Quantity::seconds,
                               .digits = 2,
                               .automatic = true});
  const PublishedTable published("schroeder-table-4.3");
  for (std::size_t i_row = 0; i_row < published.rows(); ++i_row) {
    const double n = row_number(published, i_row);
    if (n > options.most_points) continue;
    const MeasuredSum<3> sum(standard_problem<3>(static_cast<std::size_t>(n)),
                             within_pairs(options, n, std::min(n, 100.0)), 1, timed_threads(options));
    Row& row = table.rows.emplace_back(Row{fmt::format("N = {:.0f}", n), i_row, {}, {}});
    std::vector<Entry> evaluations;
    for (std::size_t i = 0; i < both.size(); ++i) {
      const Measurement hermite = sum.hermite(both[i].nu, both[i].p, all_boxes);
      const Measurement automatic = sum.automatic(hermite.absolute);
      row.entries.push_back({hermite.prepare, automatic.prepare});
      evaluations.push_back({hermite.evaluate, automatic.evaluate});
      row.note += (i > 0 ? ", " : "auto: ") + chosen(automatic);
    }
    row.entries.insert(row.entries.end(), evaluations.begin(), evaluations.end());
  }
  return {table};
}

std::vector<Table> break_even_table(const FgtdOptions& options) {
  Table table{"4.4",
              "targets from which the transform is faster than the direct sum",
              "Halton points, d = 3, sigma = 2, alpha = (0,1,2), every box. \"measured\" is prepare / (direct - "
              "evaluate) with the mean seconds of 1024 targets. \"cost\" is p^d N / (N - nu^d p^d). A - means never",
              {},
              {}};
  std::array<Parameters, 6> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = {8 + static_cast<int>(i) / 3, 2 + static_cast<int>(i) % 3};
    table.columns.push_back({.name = all[i].name() + " measured",
                             .printed = all[i].printed() + "_numerical",
                             .quantity = Quantity::factor,
                             .digits = 3,
                             .automatic = true});
    table.columns.push_back({.name = all[i].name() + " cost",
                             .printed = all[i].printed() + "_analytical",
                             .quantity = Quantity::count,
                             .comparison = Comparison::arithmetic,
                             .digits = 0});
  }
  const PublishedTable published("schroeder-table-4.4");
  for (std::size_t i_row = 0; i_row < published.rows(); ++i_row) {
    const double n = row_number(published, i_row);
    if (n > options.most_points) continue;
    const std::size_t targets = within_pairs(options, n, std::min(n, 1024.0));
    const MeasuredSum<3> sum(standard_problem<3>(static_cast<std::size_t>(n)), targets, targets,
                             timed_threads(options));
    const auto measured = [&](const Measurement& m) {
      const double won = sum.direct_seconds() - m.evaluate;
      return won > 0 ? std::ceil(m.prepare / won) : never;
    };
    Row& row = table.rows.emplace_back(Row{fmt::format("N = {:.0f}", n), i_row, {}, {}});
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto [p, nu] = all[i];
      const Measurement hermite = sum.hermite(nu, p, all_boxes);
      row.entries.push_back({measured(hermite), measured(sum.automatic(hermite.absolute))});
      const double terms = std::pow(p, 3), left = n - boxes_of(3, nu) * terms;
      row.entries.push_back({left > 0 ? std::ceil(terms * n / left) : never, {}});
    }
  }
  return {table};
}

namespace {

constexpr double published_points_45 = 50000;

/// Zeros if `direct` took the place of `hermite`.
fgtd::Hermite parameters_of(const Measurement& measurement) {
  const auto* const parameters = std::get_if<fgtd::Hermite>(&measurement.choice.parameters);
  return parameters ? *parameters : fgtd::Hermite{};
}

template <int d>
void add_dimension(std::size_t row, const FgtdOptions& options, Table& table) {
  const double n = std::min(published_points_45, options.most_points);
  const double terms = std::pow(fine.p, d);
  const MeasuredSum<d> sum(standard_problem<d>(static_cast<std::size_t>(n)), within_pairs(options, n, n),
                           within_terms(options, terms * boxes_of(d, fine.nu), n), timed_threads(options));
  const Measurement hermite = sum.hermite(fine.nu, fine.p, all_boxes), automatic = sum.automatic(hermite.absolute);
  // Millions, for the points and boxes that the sums had.
  const double boxes = static_cast<double>(parameters_of(hermite).boxes);
  const double pairs = n * n, steps = fgtd::hermite_cost(d, fine.p, boxes, n, n);
  const auto counted = n == published_points_45 ? Comparison::arithmetic : Comparison::none;
  table.rows.push_back({fmt::format("d = {}", d),
                        row,
                        {{n * sum.direct_seconds(), {}},
                         {std::round(pairs / 1e6), {}, true, counted},
                         {seconds_for(hermite, n), seconds_for(automatic, n)},
                         {std::round(steps / 1e6), {}, true, counted},
                         absolute_errors(hermite, automatic)},
                        "auto: " + chosen(automatic)});
}

}  // namespace

std::vector<Table> dimension_table(const FgtdOptions& options) {
  const double n = std::min(published_points_45, options.most_points);
  Table table{
      "4.5",
      "seconds and cost over the dimension",
      fmt::format("N = M = {:.0f} Halton points, sigma = 2, alpha = (0,...,d-1), p = 9, nu = 3, every box; pairs and "
                  "terms p^d N + boxes p^d M of these sums{}",
                  n, std::isinf(options.most_terms) ? "" : "; seconds from a sample of the targets"),
      {{.name = "direct seconds", .printed = "seconds_brute_force", .quantity = Quantity::seconds, .digits = 3},
       {.name = "millions of pairs", .printed = "mflops_brute_force", .quantity = Quantity::count, .digits = 0},
       {.name = "seconds", .printed = "seconds_fgtd", .quantity = Quantity::seconds, .digits = 3, .automatic = true},
       {.name = "millions of terms", .printed = "mflops_fgtd", .quantity = Quantity::count, .digits = 0},
       {.name = "absolute error", .automatic = true}},
      {}};
  const PublishedTable published("schroeder-table-4.5");
  for (std::size_t row = 0; row < published.rows(); ++row) {
    const int d = static_cast<int>(row_number(published, row));
    if (d == 2) add_dimension<2>(row, options, table);
    if (d == 3) add_dimension<3>(row, options, table);
    if (d == 4) add_dimension<4>(row, options, table);
  }
  return {table};
}

std::vector<Table> width_table(const FgtdOptions& options) {
  const double n = std::min(10000.0, options.most_points);
  constexpr double tolerance = 1e-8;
  Table table{
      "4.6",
      "absolute error over sigma and the neighbour boxes n",
      fmt::format("N = M = {:.0f} Halton points, d = 3, alpha = (0,1,2), p = 9, nu = 4 fixed, so that r = "
                  "sqrt(sigma/2)/4. auto has a tolerance of 1e-8, or is as accurate as n >= 2 where that is better{}",
                  n, sampled(options)),
      {{.name = "n = 0", .printed = "n0", .comparison = Comparison::order},
       {.name = "n = 1", .printed = "n1", .comparison = Comparison::order},
       {.name = "n >= 2", .printed = "n2_or_more", .comparison = Comparison::order, .automatic = true},
       {.name = "promise of auto"},
       {.name = "max |sum|"}},
      {}};
  const PublishedTable published("schroeder-table-4.6");
  for (std::size_t row = 0; row < published.rows(); ++row) {
    Problem<3> problem = standard_problem<3>(static_cast<std::size_t>(n));
    problem.sigma = row_number(published, row);
    const MeasuredSum<3> sum(problem, within_pairs(options, n, n), 0, options.threads);
    const double promise = tolerance * fgtd::derivative_scale<3>(problem.alpha, problem.sigma) * sum.total_weight();
    std::array<Measurement, 3> hermite;
    for (int i = 0; i < 3; ++i) {
      // Five boxes a side reach all four, wherever the target is [Sch06, Algorithm 3.4].
      hermite[static_cast<std::size_t>(i)] = sum.hermite(4, 9, i < 2 ? i : all_boxes);
    }
    const Measurement automatic = sum.automatic(std::min(promise, hermite[2].absolute));
    const auto& bound = hermite[2].choice.bound;
    Entry all = absolute_errors(hermite[2], automatic);
    // Where the series is exact to rounding, the error is that of the sums, which were less careful then.
    if (hermite[2].absolute < rounding * fgtd::derivative_scale<3>(problem.alpha, problem.sigma) * sum.total_weight())
      all.comparison = Comparison::at_most;
    table.rows.push_back(
        {fmt::format("sigma = {:g}", problem.sigma),
         row,
         {{hermite[0].absolute, {}}, {hermite[1].absolute, {}}, all, {automatic.allowed, {}}, {sum.largest(), {}}},
         fmt::format("r = {:.4g}, {}; auto: {}", parameters_of(hermite[2]).box_scale,
                     bound ? "bound holds" : "no bound", chosen(automatic))});
  }
  return {table};
}

std::vector<Table> spacing_table(const FgtdOptions& options) {
  Table table{"4.7",
              "absolute error over the lattice and the overlap c",
              "d = 2, n_g^2 lattice points of spacing h = 1/(n_g-1), weights 1/n_g^2 (not stated), sigma = 1/(c h)^2, "
              "alpha = 0, p = 9, r = 0.25, n = 20, nu as printed" +
                  sampled(options),
              {},
              {}};
  constexpr std::array<int, 3> lattices{100, 200, 300};
  for (const int per_axis : lattices) {
    table.columns.push_back({.name = fmt::format("n_g={} nu", per_axis),
                             .printed = fmt::format("ng{}_nu", per_axis),
                             .quantity = Quantity::count,
                             .comparison = Comparison::arithmetic,
                             .digits = 0});
    table.columns.push_back({.name = fmt::format("n_g={} error", per_axis),
                             .printed = fmt::format("ng{}_error", per_axis),
                             .comparison = Comparison::order,
                             .automatic = true});
  }
  const PublishedTable published("schroeder-table-4.7");
  for (std::size_t i_row = 0; i_row < published.rows(); ++i_row) {
    const double overlap = row_number(published, i_row);
    Row& row = table.rows.emplace_back(Row{fmt::format("c = {:g}", overlap), i_row, {}, {}});
    for (const int per_axis : lattices) {
      const double h = 1.0 / (per_axis - 1), n = static_cast<double>(per_axis) * per_axis;
      if (n > options.most_points) {
        row.entries.insert(row.entries.end(), 2, Entry{});
        continue;
      }
      // The thesis writes ceil(1 / (r sqrt(2) c h)) and prints the floor, as 1/h is not quite an integer there.
      const int nu = static_cast<int>(std::floor(1 / (0.25 * std::sqrt(2.0) * overlap * h)));
      const Problem<2> problem{grid_points<2>(static_cast<std::size_t>(per_axis), h),
                               Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(n), 1, 1 / n),
                               1 / std::pow(overlap * h, 2),
                               {}};
      const MeasuredSum<2> sum(problem, within_pairs(options, n, n), 0, options.threads);
      const Measurement hermite = sum.hermite(nu, 9, 2 * 20 + 1 >= nu ? all_boxes : 20);
      row.entries.push_back({static_cast<double>(nu), {}});
      row.entries.push_back(absolute_errors(hermite, sum.automatic(hermite.absolute)));
    }
  }
  return {table};
}

namespace {

// The columns of Table 4.8; n = -1 is as many as give every box.
struct Situation48 {
  const char* printed;
  double sigma;
  int nu, neighbours;
};
constexpr std::array<Situation48, 6> situations_48{{{"sigma0.01_nu1_n0", 0.01, 1, 0},
                                                    {"sigma1_nu3_n0", 1, 3, 0},
                                                    {"sigma1_nu3_n1_or_more", 1, 3, -1},
                                                    {"sigma100_nu29_n0", 100, 29, 0},
                                                    {"sigma100_nu29_n3", 100, 29, 3},
                                                    {"sigma100_nu29_n14_or_more", 100, 29, -1}}};

}  // namespace

std::vector<Table> point_set_table(const FgtdOptions& options) {
  constexpr std::size_t per_axis = 17, count = per_axis * per_axis * per_axis;
  Table table{
      "4.8",
      "relative error over the point set",
      "N = M = 17^3 points, d = 3, alpha = 0, weights 1/4913, p = 9, r = 0.25, nu boxes an axis; Halton numbers "
      "0..4912; grid i/17; random and clustered (17 cubes of side 0.1) are our own" +
          std::string(std::isinf(options.most_terms) ? "" : "; sigma=100 n=all at a sample of the targets"),
      {},
      {}};
  for (const Situation48& column : situations_48)
    table.columns.push_back({.name = fmt::format("sigma={:g} n={}", column.sigma,
                                                 column.neighbours < 0 ? "all" : fmt::format("{}", column.neighbours)),
                             .printed = column.printed,
                             .comparison = Comparison::order,
                             .digits = 3,
                             .automatic = true});
  const PublishedTable published("schroeder-table-4.8");
  const std::array<fgtd::Points<3>, 4> sets{halton_points<3>(count), random_points<3>(count, 1),
                                            grid_points<3>(per_axis, 1.0 / per_axis),
                                            clustered_points<3>(count, 17, 0.1, 1)};
  constexpr std::array<const char*, 4> names{"halton", "random", "grid", "clustered"};  // as the sets
  for (std::size_t row = 0; row < sets.size(); ++row) {
    Row& added = table.rows.emplace_back(Row{published.row_name(row), row, {}, {}});
    if (added.name != names[row]) throw Error(ExitCode::internal, "Table 4.8 has other point sets than are computed");
    const bool known = row == 0 || row == 2;  // which points the thesis had
    for (std::size_t i = 0; i < situations_48.size(); ++i) {
      const Situation48& column = situations_48[i];
      const Problem<3> problem{sets[row], Eigen::MatrixXd::Constant(count, 1, 1.0 / count), column.sigma, {}};
      const double boxes_a_target = std::pow(column.neighbours < 0 ? column.nu : 2 * column.neighbours + 1, 3);
      const std::size_t compared = within_terms(options, boxes_a_target * std::pow(9, 3), count);
      const MeasuredSum<3> sum(problem, compared, 0, options.threads);
      const Measurement hermite = sum.hermite(column.nu, 9, column.neighbours < 0 ? all_boxes : column.neighbours);
      Entry& entry = added.entries.emplace_back(relative_errors(hermite, sum.automatic(hermite.absolute)));
      if (hermite.relative < rounding)
        entry.comparison = Comparison::at_most;  // the error of the sums, which were less careful then
      else if (known)
        entry.comparison = compared == count ? Comparison::digits : Comparison::at_most;
    }
  }
  return {table};
}

std::vector<Table> level_table(const FgtdOptions& options) {
  const double n = std::min(10000.0, options.most_points);
  Table table{"4.9",
              "seconds and error over the compiler's optimisation level",
              fmt::format("N = M = {:.0f} Halton points, d = 3, sigma = 2, alpha = (0,1,2), p = 9, nu = 3, every box. "
                          "The thesis does not say which error it prints; the relative one has its power of ten. This "
                          "program was compiled at one level; ninja bench_levels measures the others",
                          n),
              {{.name = "seconds", .printed = "seconds", .quantity = Quantity::seconds, .digits = 3},
               {.name = "relative error", .printed = "error", .comparison = Comparison::order, .digits = 3},
               {.name = "absolute error", .digits = 3}},
              {}};
  const PublishedTable published("schroeder-table-4.9");
  const auto count = static_cast<std::size_t>(n);
  const MeasuredSum<3> sum(standard_problem<3>(count), count, count, timed_threads(options));
  const Measurement hermite = sum.hermite(fine.nu, fine.p, all_boxes);
  for (std::size_t row = 0; row < published.rows(); ++row) {
    Row& added = table.rows.emplace_back(Row{"level " + published.row_name(row), row, {{}, {}, {}}, {}});
    if (published.row_name(row) == "O3")
      added.entries = {{seconds_for(hermite, n), {}}, {hermite.relative, {}}, {hermite.absolute, {}}};
  }
  return {table};
}

}  // namespace gaussdrift::reproduce
