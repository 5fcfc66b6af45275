#include "study/fgtd_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "study/measured_sum.hpp"
#include "study/point_sets.hpp"
#include "study/published_fgtd.hpp"

namespace gaussdrift::study {

namespace {

constexpr int all_boxes = fgtd::HermiteParameters::all_boxes;

// The two choices of parameters that chapter 4 measures.
struct Parameters {
  int p, nu;
  std::string name() const { return fmt::format("p={} nu={}", p, nu); }
};
constexpr Parameters coarse{8, 2}, fine{9, 3};
constexpr std::array<Parameters, 2> both{coarse, fine};

double boxes_of(int d, int nu) { return std::pow(nu, d); }

// How many of `points` targets a direct sum over as many sources may have.
std::size_t within_pairs(const FgtdOptions& options, double sources, double targets) {
  return static_cast<std::size_t>(std::clamp(options.most_pairs / sources, 1.0, targets));
}

std::size_t within_terms(const FgtdOptions& options, double terms_a_target, double targets) {
  return static_cast<std::size_t>(std::clamp(options.most_terms / terms_a_target, 1.0, targets));
}

int timed_threads(const FgtdOptions& options) { return options.threads > 0 ? options.threads : 1; }

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

Entry compare(double published, double computed) { return {published, computed, {}}; }
Entry compare(double published, double computed, double automatic) { return {published, computed, automatic}; }
Entry absolute_errors(std::optional<double> published, const Measurement& hermite, const Measurement& automatic) {
  return {published, hermite.absolute, automatic.absolute, automatic.absolute <= automatic.allowed};
}
Entry relative_errors(double published, const Measurement& hermite, const Measurement& automatic) {
  return {published, hermite.relative, automatic.relative, automatic.absolute <= automatic.allowed};
}

std::string chosen(const Measurement& automatic) {
  return fmt::format("{} {:.0e}", fgtd::to_string(automatic.choice.method), automatic.choice.tolerance);
}

double seconds_for(const Measurement& measured, double targets) {
  return measured.prepare + targets * measured.evaluate;
}

std::vector<Column> columns_of_p(Quantity quantity, int digits, bool automatic) {
  std::vector<Column> columns;
  for (const int p : published::terms) columns.push_back({fmt::format("p={}", p), quantity, 0, digits, automatic});
  return columns;
}

}  // namespace

std::vector<Table> analytic_tables() {
  Table cost{"3.2",
             "cost p^d N + nu^d p^d M",
             "d = 3, N = M = 1; nothing is summed",
             columns_of_p(Quantity::count, 0, false),
             {}};
  Table bound{"3.3",
              "bound (3.5)",
              "d = 3, every box, r = 1/nu (sigma = 2), alpha = 0, Q = 1; nothing is summed",
              columns_of_p(Quantity::bound, 1, false),
              {}};
  const auto add = [](Table& table, const auto& rows, const auto& number) {
    for (const auto& row : rows) {
      Row& added = table.rows.emplace_back();
      added.name = fmt::format("nu = {}", row.nu);
      for (std::size_t i = 0; i < row.value.size(); ++i)
        added.entries.push_back(compare(row.value[i], number(row.nu, published::terms[i])));
    }
  };
  add(cost, published::table_32, [](int nu, int p) { return fgtd::hermite_cost(3, p, boxes_of(3, nu), 1, 1); });
  add(bound, published::table_33,
      [](int nu, int p) { return fgtd::hermite_bound<3>(1.0 / nu, p, all_boxes, {}).value(); });
  return {cost, bound};
}

std::vector<Table> parameter_tables() {
  constexpr std::size_t count = 12;
  const std::string taken = fmt::format(
      "d = 3, sigma = 2, alpha = 0, every box; number of points not stated: {} Halton points, weights scaled to Q = 1",
      count);
  Table error{"3.4", "absolute error", taken, columns_of_p(Quantity::error, 1, true), {}};
  Table time{"3.5",
             "microseconds to prepare and evaluate at all points",
             taken + "; published as hundredths of a second, which 12 points make plausible; one thread",
             columns_of_p(Quantity::seconds, 3, true),
             {}};
  Problem<3> problem{halton_points<3>(count), halton_weights(count, 3), 2.0, {}};
  problem.weights /= problem.weights.sum();
  const MeasuredSum<3> sum(problem, count, count, 1);
  for (std::size_t row = 0; row < published::table_34.size(); ++row) {
    const int nu = published::table_34[row].nu;
    Row& errors_of_nu = error.rows.emplace_back();
    Row& times_of_nu = time.rows.emplace_back();
    errors_of_nu.name = times_of_nu.name = fmt::format("nu = {}", nu);
    for (std::size_t i = 0; i < published::terms.size(); ++i) {
      const Measurement hermite = sum.hermite(nu, published::terms[i], all_boxes);
      const Measurement automatic = sum.automatic(hermite.absolute);
      errors_of_nu.entries.push_back(absolute_errors(published::table_34[row].value[i], hermite, automatic));
      times_of_nu.entries.push_back(compare(1e4 * published::table_35[row].value[i], 1e6 * seconds_for(hermite, count),
                                            1e6 * seconds_for(automatic, count)));
    }
  }
  return {error, time};
}

std::vector<Table> point_number_tables(const FgtdOptions& options) {
  const std::string what = "N = M Halton points, d = 3, sigma = 2, alpha = (0,1,2), every box" + sampled(options);
  Table error{"4.1",
              "error over the number of points",
              what +
                  "; a relative error hangs on the one target where the sum is nearest to 0 and may be a power of ten "
                  "off, as may the bound",
              {},
              {}};
  Table time{"4.2", "seconds over the number of points", what, {{"direct", Quantity::seconds, 0, 3}}, {}};
  for (const Parameters& q : both) {
    error.columns.push_back({q.name() + " bound", Quantity::bound, 1});
    error.columns.push_back({q.name() + " absolute", Quantity::error, 0, 1, true});
    error.columns.push_back({q.name() + " relative", Quantity::error, 1, 1, true});
    time.columns.push_back({q.name() + " seconds", Quantity::seconds, 0, 3, true});
    time.columns.push_back({q.name() + " times faster", Quantity::factor, 0, 3, true});
  }
  for (std::size_t row = 0; row < published::table_41.size(); ++row) {
    const auto& errors_then = published::table_41[row];
    const auto& times_then = published::table_42[row];
    const double n = errors_then.points;
    if (n > options.most_points) continue;
    const Problem<3> problem = standard_problem<3>(static_cast<std::size_t>(n));
    const MeasuredSum<3> sum(problem, within_pairs(options, n, n),
                             within_terms(options, fgtd::hermite_cost(3, fine.p, boxes_of(3, fine.nu), 0, 1), n),
                             timed_threads(options));
    const double direct = n * sum.direct_seconds();
    Row& error_row = error.rows.emplace_back();
    Row& time_row = time.rows.emplace_back();
    error_row.name = time_row.name = fmt::format("N = {:.0f}", n);
    time_row.entries.push_back(compare(times_then.direct, direct));
    const auto faster = [&](double seconds) { return seconds < direct ? direct / seconds : published::never; };
    for (std::size_t i = 0; i < both.size(); ++i) {
      const auto [p, nu] = both[i];
      const Measurement hermite = sum.hermite(nu, p, all_boxes), automatic = sum.automatic(hermite.absolute);
      const double bound = fgtd::hermite_bound<3>(1.0 / nu, p, all_boxes, problem.alpha).value() * std::pow(2.0, 1.5);
      error_row.entries.push_back(compare(errors_then.error[i][0], bound * sum.total_weight()));
      error_row.entries.push_back(absolute_errors(errors_then.error[i][1], hermite, automatic));
      error_row.entries.push_back(relative_errors(errors_then.error[i][2], hermite, automatic));
      const double now = seconds_for(hermite, n), third = seconds_for(automatic, n);
      time_row.entries.push_back(compare(times_then.seconds[i], now, third));
      time_row.entries.push_back(compare(times_then.factor[i], faster(now), faster(third)));
      time_row.note += (i > 0 ? ", " : "auto: ") + chosen(automatic);
    }
    error_row.note = time_row.note;
  }
  return {error, time};
}

std::vector<Table> preparation_table(const FgtdOptions& options) {
  Table table{
      "4.3",
      "seconds to prepare N sources, and to evaluate one target",
      "Halton points, d = 3, sigma = 2, alpha = (0,1,2), every box; automatic is planned for as many targets as "
      "sources",
      {},
      {}};
  for (const char* part : {"prepare", "evaluate"})
    for (const Parameters& q : both)
      table.columns.push_back({fmt::format("{} {}", part, q.name()), Quantity::seconds, 0, 2, true});
  for (const auto& then : published::table_43) {
    const double n = then.sources;
    if (n > options.most_points) continue;
    const MeasuredSum<3> sum(standard_problem<3>(static_cast<std::size_t>(n)),
                             within_pairs(options, n, std::min(n, 100.0)), 1, timed_threads(options));
    Row& row = table.rows.emplace_back();
    row.name = fmt::format("N = {:.0f}", n);
    std::vector<Entry> evaluations;
    for (std::size_t i = 0; i < both.size(); ++i) {
      const Measurement hermite = sum.hermite(both[i].nu, both[i].p, all_boxes);
      const Measurement automatic = sum.automatic(hermite.absolute);
      row.entries.push_back(compare(then.prepare[i], hermite.prepare, automatic.prepare));
      evaluations.push_back(compare(then.evaluate[i], hermite.evaluate, automatic.evaluate));
      row.note += (i > 0 ? ", " : "auto: ") + chosen(automatic);
    }
    row.entries.insert(row.entries.end(), evaluations.begin(), evaluations.end());
  }
  return {table};
}

std::vector<Table> break_even_table(const FgtdOptions& options) {
  Table table{"4.4",
              "targets from which the transform is faster than the direct sum",
              "Halton points, d = 3, sigma = 2, alpha = (0,1,2), every box; measured: prepare / (direct - evaluate), "
              "seconds a target averaged over 1024 targets; cost: p^d N / (N - nu^d p^d); -: never",
              {},
              {}};
  std::array<Parameters, 6> all;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = {8 + static_cast<int>(i) / 3, 2 + static_cast<int>(i) % 3};
    table.columns.push_back({all[i].name() + " measured", Quantity::factor, 0, 3, true});
    table.columns.push_back({all[i].name() + " cost", Quantity::count, 0, 0});
  }
  for (const auto& then : published::table_44) {
    const double n = then.sources;
    if (n > options.most_points) continue;
    const std::size_t targets = within_pairs(options, n, std::min(n, 1024.0));
    const MeasuredSum<3> sum(standard_problem<3>(static_cast<std::size_t>(n)), targets, targets,
                             timed_threads(options));
    const auto measured = [&](const Measurement& m) {
      const double won = sum.direct_seconds() - m.evaluate;
      return won > 0 ? std::ceil(m.prepare / won) : published::never;
    };
    Row& row = table.rows.emplace_back();
    row.name = fmt::format("N = {:.0f}", n);
    for (std::size_t i = 0; i < all.size(); ++i) {
      const auto [p, nu] = all[i];
      const Measurement hermite = sum.hermite(nu, p, all_boxes);
      row.entries.push_back(compare(then.numerical[i], measured(hermite), measured(sum.automatic(hermite.absolute))));
      const double terms = std::pow(p, 3), left = n - boxes_of(3, nu) * terms;
      row.entries.push_back(compare(then.analytical[i], left > 0 ? std::ceil(terms * n / left) : published::never));
    }
  }
  return {table};
}

namespace {

template <int d>
void add_dimension(const published::Row45& then, const FgtdOptions& options, Table& table) {
  const double n = std::min(50000.0, options.most_points);
  const double terms = std::pow(fine.p, d), boxes = boxes_of(d, fine.nu);
  const MeasuredSum<d> sum(standard_problem<d>(static_cast<std::size_t>(n)), within_pairs(options, n, n),
                           within_terms(options, terms * boxes, n), timed_threads(options));
  const Measurement hermite = sum.hermite(fine.nu, fine.p, all_boxes), automatic = sum.automatic(hermite.absolute);
  table.rows.push_back(
      {fmt::format("d = {}", d),
       {compare(then.direct_seconds, n * sum.direct_seconds()),
        compare(then.direct_cost, std::round(50000.0 * 50000.0 / 1e6)),
        compare(then.seconds, seconds_for(hermite, n), seconds_for(automatic, n)),
        // the thesis rounds to five digits at most
        compare(then.cost, d == 4 ? std::round(fgtd::hermite_cost(d, fine.p, boxes, 5e4, 5e4) / 1e8) * 100
                                  : std::round(fgtd::hermite_cost(d, fine.p, boxes, 5e4, 5e4) / 1e6)),
        absolute_errors({}, hermite, automatic)},
       "auto: " + chosen(automatic)});
}

}  // namespace

std::vector<Table> dimension_table(const FgtdOptions& options) {
  const double n = std::min(50000.0, options.most_points);
  Table table{"4.5",
              "seconds and cost over the dimension",
              fmt::format("N = M = {:.0f} Halton points, sigma = 2, alpha = (0,...,d-1), p = 9, nu = 3, every box{}", n,
                          std::isinf(options.most_terms) ? "" : "; seconds from a sample of the targets"),
              {{"direct seconds", Quantity::seconds, 0, 3},
               {"millions of pairs", Quantity::count, 0, 0},
               {"seconds", Quantity::seconds, 0, 3, true},
               {"millions of terms", Quantity::count, 0, 0},
               {"absolute error", Quantity::error, 0, 1, true, false}},
              {}};
  add_dimension<2>(published::table_45[0], options, table);
  add_dimension<3>(published::table_45[1], options, table);
  add_dimension<4>(published::table_45[2], options, table);
  return {table};
}

std::vector<Table> width_table(const FgtdOptions& options) {
  const double n = std::min(10000.0, options.most_points);
  constexpr double tolerance = 1e-8;
  Table table{"4.6",
              "absolute error over sigma and the neighbour boxes n",
              fmt::format("N = M = {:.0f} Halton points, d = 3, alpha = (0,1,2), p = 9, nu = 4 fixed, so that r = "
                          "sqrt(sigma/2)/4; automatic: tolerance 1e-8, or as accurate as n >= 2 where that is better{}",
                          n, sampled(options)),
              {{"n = 0", Quantity::error},
               {"n = 1", Quantity::error},
               {"n >= 2", Quantity::error, 0, 1, true},
               {"promise of auto", Quantity::error, 0, 1, false, false},
               {"max |sum|", Quantity::error, 0, 1, false, false}},
              {}};
  for (const auto& then : published::table_46) {
    Problem<3> problem = standard_problem<3>(static_cast<std::size_t>(n));
    problem.sigma = then.sigma;
    const MeasuredSum<3> sum(problem, within_pairs(options, n, n), 0, options.threads);
    const double promise = tolerance * fgtd::derivative_scale<3>(problem.alpha, problem.sigma) * sum.total_weight();
    std::array<Measurement, 3> hermite;
    for (int i = 0; i < 3; ++i) {
      // Five boxes a side reach all four, wherever the target is [Sch06, Algorithm 3.4].
      hermite[static_cast<std::size_t>(i)] = sum.hermite(4, 9, i < 2 ? i : all_boxes);
    }
    const Measurement automatic = sum.automatic(std::min(promise, hermite[2].absolute));
    const auto& bound = hermite[2].choice.bound;
    table.rows.push_back({fmt::format("sigma = {:g}", then.sigma),
                          {compare(then.error[0], hermite[0].absolute),
                           compare(then.error[1], hermite[1].absolute),
                           absolute_errors(then.error[2], hermite[2], automatic),
                           {{}, automatic.allowed, {}},
                           {{}, sum.largest(), {}}},
                          fmt::format("r = {:.4g}, {}; auto: {}", hermite[2].choice.box_scale,
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
  for (const int per_axis : published::lattices) {
    table.columns.push_back({fmt::format("n_g={} nu", per_axis), Quantity::count, 0, 0});
    table.columns.push_back({fmt::format("n_g={} error", per_axis), Quantity::error, 0, 1, true});
  }
  for (const auto& then : published::table_47) {
    Row& row = table.rows.emplace_back();
    row.name = fmt::format("c = {}", then.overlap);
    for (std::size_t i = 0; i < published::lattices.size(); ++i) {
      const int per_axis = published::lattices[i];
      const double h = 1.0 / (per_axis - 1), n = static_cast<double>(per_axis) * per_axis;
      if (n > options.most_points) {
        row.entries.insert(row.entries.end(), 2, Entry{});
        continue;
      }
      // The thesis writes ceil(1 / (r sqrt(2) c h)) and prints the floor, as 1/h is not quite an integer there.
      const int nu = static_cast<int>(std::floor(1 / (0.25 * std::sqrt(2.0) * then.overlap * h)));
      const Problem<2> problem{grid_points<2>(static_cast<std::size_t>(per_axis), h),
                               Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(n), 1, 1 / n),
                               1 / std::pow(then.overlap * h, 2),
                               {}};
      const MeasuredSum<2> sum(problem, within_pairs(options, n, n), 0, options.threads);
      const Measurement hermite = sum.hermite(nu, 9, 2 * 20 + 1 >= nu ? all_boxes : 20);
      row.entries.push_back(compare(then.nu[i], nu));
      row.entries.push_back(absolute_errors(then.error[i], hermite, sum.automatic(hermite.absolute)));
    }
  }
  return {table};
}

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
  for (const auto& column : published::columns_48)
    table.columns.push_back({fmt::format("sigma={:g} n={}", column.sigma,
                                         column.neighbours < 0 ? "all" : fmt::format("{}", column.neighbours)),
                             Quantity::error, 0, 3, true});
  const std::array<fgtd::Points<3>, 4> sets{halton_points<3>(count), random_points<3>(count, 1),
                                            grid_points<3>(per_axis, 1.0 / per_axis),
                                            clustered_points<3>(count, 17, 0.1, 1)};
  for (std::size_t row = 0; row < sets.size(); ++row) {
    Row& added = table.rows.emplace_back();
    added.name = published::table_48[row].data;
    for (std::size_t i = 0; i < published::columns_48.size(); ++i) {
      const auto& column = published::columns_48[i];
      const Problem<3> problem{sets[row], Eigen::MatrixXd::Constant(count, 1, 1.0 / count), column.sigma, {}};
      const double boxes_a_target = std::pow(column.neighbours < 0 ? column.nu : 2 * column.neighbours + 1, 3);
      const MeasuredSum<3> sum(problem, within_terms(options, boxes_a_target * std::pow(9, 3), count), 0,
                               options.threads);
      const Measurement hermite = sum.hermite(column.nu, 9, column.neighbours < 0 ? all_boxes : column.neighbours);
      const Measurement automatic = sum.automatic(hermite.absolute);
      added.entries.push_back(relative_errors(published::table_48[row].error[i], hermite, automatic));
    }
  }
  return {table};
}

}  // namespace gaussdrift::study
