// Tables 6.1 and 6.2 of [Sch06]: the divergence-free field S and its numerical divergence.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "field/gaussians/divergence_free.hpp"
#include "reproduce/fgtd_tables.hpp"
#include "reproduce/measured_sum.hpp"
#include "reproduce/point_sets.hpp"
#include "reproduce/published.hpp"

namespace gaussdrift::reproduce {

namespace {

using Index = Eigen::Index;

// "The same conditions as in chapter 4" [Sch06, 6.6]; of the two choices of parameters there, p = 9 and nu = 3 explain
// the times: 12 evaluations of 4.17 s (Table 4.2) are the 48 s at 20 000 points.
constexpr double sigma = 2;
constexpr int terms = 9, boxes_an_axis = 3;

// Halton numbers to the bases after those of the points; the mean 1/2 gives the thesis's Q of about N/2 a component.
Eigen::MatrixXd halton_coefficients(std::size_t count) {
  constexpr std::array<int, 3> bases{7, 11, 13};
  Eigen::MatrixXd gamma(static_cast<Index>(count), 3);
  for (std::size_t k = 0; k < count; ++k)
    for (std::size_t l = 0; l < 3; ++l) gamma(static_cast<Index>(k), static_cast<Index>(l)) = halton(k, bases[l]);
  return gamma;
}

GaussianSumOptions hermite_options(int derivative_order, int threads) {
  return {.derivative_order = derivative_order,
          .threads = threads,
          .hermite = fgtd::HermiteParameters{.box_scale = box_scale(boxes_an_axis, sigma), .expansion_order = terms}};
}

struct FieldTimes {
  double absolute = 0, relative = 0;
  double seconds = 0;  // to prepare and evaluate at all points
};

class MeasuredField {
 public:
  MeasuredField(std::size_t count, std::size_t compared, std::size_t timed, int threads)
      : points_(halton_points<3>(count)),
        gamma_(halton_coefficients(count)),
        compared_(sample<3>(points_, compared)),
        timed_(sample<3>(points_, timed)),
        threads_(threads) {
    const GaussianSum<3> pairs(points_, gamma_, sigma, {.method = fgtd::Method::direct, .threads = threads});
    unit_error_ = pairs.unit_error(GaussianMatrix::field);
    direct_seconds_ = fastest_seconds([&] { exact_ = pairs.evaluate(GaussianMatrix::field, compared_); }) *
                      static_cast<double>(count) / static_cast<double>(compared_.cols());
  }
  double direct_seconds() const { return direct_seconds_; }
  double unit_error() const { return unit_error_; }

  FieldTimes hermite() const {
    return measure(with_corners<3>(points_), with_corners(gamma_), hermite_options(2, threads_), timed_);
  }
  FieldTimes automatic(double tolerance) const {
    return measure(points_, gamma_, {.tolerance = tolerance, .threads = threads_}, points_);
  }

 private:
  FieldTimes measure(const fgtd::Points<3>& sources, const Eigen::MatrixXd& gamma, const GaussianSumOptions& options,
                     const fgtd::Points<3>& timed) const {
    FieldTimes result;
    const GaussianSum<3> sum(sources, gamma, sigma, options);
    const Eigen::ArrayXXd error = (sum.evaluate(GaussianMatrix::field, compared_) - exact_).array().abs();
    // A NaN is no small error, but maxCoeff() may step over it.
    const bool broken = !error.allFinite();
    result.absolute = broken ? std::numeric_limits<double>::infinity() : error.maxCoeff();
    result.relative = broken ? std::numeric_limits<double>::infinity() : (error / exact_.array().abs()).maxCoeff();
    const double prepare = fastest_seconds([&] { GaussianSum<3>(sources, gamma, sigma, options); });
    const double evaluate = fastest_seconds([&] { sum.evaluate(GaussianMatrix::field, timed); });
    result.seconds = prepare + evaluate * static_cast<double>(points_.cols()) / static_cast<double>(timed.cols());
    return result;
  }

  fgtd::Points<3> points_;
  Eigen::MatrixXd gamma_;
  fgtd::Points<3> compared_, timed_;
  int threads_;
  Eigen::MatrixXd exact_;  // at compared_
  double direct_seconds_ = 0, unit_error_ = 0;
};

}  // namespace

std::vector<Table> field_table(const FgtdOptions& options) {
  Table table{
      "6.1",
      "the field S(y): time and error",
      fmt::format("N = M Halton points, d = 3, sigma = 2, p = 9, nu = 3, every box. The thesis does not state "
                  "Gamma; here it consists of Halton numbers. The relative error depends on it, because it is that of "
                  "the component nearest to 0{}",
                  std::isinf(options.most_pairs)
                      ? ""
                      : fmt::format(". Beyond {:.0e} pairs the sums by pairs are taken at a sample of the targets",
                                    options.most_pairs)),
      {{.name = "pairs seconds", .printed = "seconds_brute_force", .quantity = Quantity::seconds, .digits = 3},
       {.name = "fgtd seconds",
        .printed = "seconds_fgtd",
        .quantity = Quantity::seconds,
        .digits = 3,
        .automatic = true},
       {.name = "absolute",
        .printed = "absolute_error",
        .comparison = Comparison::order,
        .automatic = true,
        .why_off = "just beyond the end of the printed power of ten"},
       {.name = "relative", .printed = "relative_error", .comparison = Comparison::at_most, .automatic = true},
       {.name = "times faster", .printed = "speedup", .quantity = Quantity::factor, .digits = 3, .automatic = true}},
      {}};
  const PublishedTable published("schroeder-table-6.1");
  for (std::size_t i = 0; i < published.rows(); ++i) {
    const double n = *published.number(i, "points");
    if (n > options.most_points) continue;
    const double terms_a_target = 18 * fgtd::hermite_cost(3, terms, std::pow(boxes_an_axis, 3), 0, 1);
    const auto targets_within = [n](double limit, double a_target) {
      return static_cast<std::size_t>(std::clamp(limit / a_target, 1.0, n));
    };
    const MeasuredField field(static_cast<std::size_t>(n), targets_within(options.most_pairs, n),
                              targets_within(options.most_terms, terms_a_target), timed_threads(options));
    const FieldTimes hermite = field.hermite();
    const double tolerance = std::clamp(hermite.absolute / field.unit_error(), fgtd::smallest_tolerance, 0.1);
    const FieldTimes automatic = field.automatic(tolerance);
    const bool kept = automatic.absolute <= (tolerance + rounding) * field.unit_error();
    const double direct = field.direct_seconds();
    Row& row = table.rows.emplace_back(Row{fmt::format("N = {:.0f}", n), i, {}, {}});
    row.entries = {{direct, {}},
                   {hermite.seconds, automatic.seconds},
                   {hermite.absolute, automatic.absolute, kept},
                   {hermite.relative, automatic.relative, kept},
                   {direct / hermite.seconds, direct / automatic.seconds}};
    row.note = fmt::format("auto: tolerance {:.0e}", tolerance);
  }
  return {table};
}

namespace {

constexpr std::size_t all_axes = 3;

/// sum_i d_i S_i by differences of S along every axis, of order 8; the size of its three terms beside it.
Divergence divergence_by_differences(const GaussianSum<3>& sum, const Eigen::Vector3d& target) {
  // Errors: h^8 |d^9 S| / 630, which is 1e-14 of the terms, and rounding of S over h.
  constexpr double h = 0.01;
  constexpr std::array<double, 4> weights{4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  fgtd::Points<3> around(3, 2 * weights.size() * all_axes);
  Index column = 0;
  for (Index axis = 0; axis < 3; ++axis)
    for (std::size_t k = 0; k < weights.size(); ++k)
      for (const double sign : {1.0, -1.0}) {
        around.col(column) = target;
        around(axis, column++) += sign * static_cast<double>(k + 1) * h;
      }
  const Eigen::MatrixXd values = sum.evaluate(GaussianMatrix::field, around);
  Divergence result{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Zero(1)};
  column = 0;
  for (Index axis = 0; axis < 3; ++axis) {
    double term = 0;
    for (const double weight : weights) {
      term += weight * (values(column, axis) - values(column + 1, axis)) / h;
      column += 2;
    }
    result.value[0] += term;
    result.terms[0] += std::abs(term);
  }
  return result;
}

/// d_i S_i of one sum, i the axis.
double own_derivative(const GaussianSum<3>& sum, int axis, const fgtd::Points<3>& target) {
  fgtd::Derivative<3> alpha{};
  alpha[static_cast<std::size_t>(axis)] = 1;
  return sum.component(GaussianMatrix::field, axis, target, alpha)[0];
}

double relative(const Divergence& result) { return std::abs(result.value[0]) / result.terms[0]; }

/// Of n sources: row i of the table.
Row divergence_row(std::size_t i, double n, int threads) {
  const fgtd::Points<3> target = Eigen::Vector3d::Constant(0.5);
  const auto count = static_cast<std::size_t>(n);
  const fgtd::Points<3> points = halton_points<3>(count), cube = with_corners<3>(points);
  const Eigen::MatrixXd gamma = halton_coefficients(count), padded = with_corners(gamma);
  const auto divergence = [&](const fgtd::Points<3>& sources, const Eigen::MatrixXd& coefficients,
                              const GaussianSumOptions& with) {
    return GaussianSum<3>(sources, coefficients, sigma, with).divergence(GaussianMatrix::field, target);
  };
  const GaussianSumOptions direct_options{.derivative_order = 3, .method = fgtd::Method::direct, .threads = threads};
  Divergence direct, hermite;
  const double direct_seconds = fastest_seconds([&] { direct = divergence(points, gamma, direct_options); });
  const double hermite_seconds =
      fastest_seconds([&] { hermite = divergence(cube, padded, hermite_options(3, threads)); });
  const double automatic_seconds = fastest_seconds(
      [&] { divergence(points, gamma, {.derivative_order = 3, .threads = threads, .expected_targets = 1}); });

  const GaussianSum<3> by_pairs(points, gamma, sigma, direct_options),
      by_hermite(cube, padded, sigma, hermite_options(3, threads)),
      by_chebyshev(points, gamma, sigma,
                   {.tolerance = 1e-6, .derivative_order = 3, .method = fgtd::Method::chebyshev, .threads = threads});
  const double apart = own_derivative(by_hermite, 0, target) + own_derivative(by_chebyshev, 1, target) +
                       own_derivative(by_pairs, 2, target);
  const double of_hermite = own_derivative(by_hermite, 0, target) - own_derivative(by_pairs, 0, target);
  double size = 0;
  for (const int axis : {0, 1, 2}) size += std::abs(own_derivative(by_pairs, axis, target));

  Row row{fmt::format("N = {:.0f}", n), i, {}, {}};
  row.entries = {{direct_seconds, {}},
                 {std::abs(direct.value[0]), {}},
                 {hermite_seconds, automatic_seconds},
                 {std::abs(hermite.value[0]), {}},
                 {relative(divergence_by_differences(by_pairs, target.col(0))), {}},
                 {relative(divergence_by_differences(by_hermite, target.col(0))), {}},
                 {std::abs(apart) / size, {}},
                 {std::abs(of_hermite) / size, {}}};
  return row;
}

}  // namespace

std::vector<Table> divergence_table(const FgtdOptions& options) {
  Table table{"6.2",
              "numerical divergence of S",
              "at one target, (1/2, 1/2, 1/2). Every term of Lemma 6.4.1 is there twice with opposite signs. So one "
              "plan of fgtd "
              "gives 0 however wrong it is, and that 0 is not compared. The last columns are relative to the size of "
              "the terms:\n"
              "  differences  div S from differences of S along the axes\n"
              "  apart        d_1 S_1 by hermite, d_2 S_2 by chebyshev, d_3 S_3 by pairs\n"
              "  error        the error of hermite in d_1 S_1",
              {{.name = "pairs seconds", .printed = "seconds_brute_force", .quantity = Quantity::seconds, .digits = 3},
               {.name = "pairs", .printed = "divergence_brute_force", .comparison = Comparison::at_most},
               {.name = "fgtd seconds",
                .printed = "seconds_fgtd",
                .quantity = Quantity::seconds,
                .digits = 3,
                .automatic = true},
               {.name = "fgtd", .printed = "divergence_fgtd"},
               {.name = "pairs differences"},
               {.name = "fgtd differences"},
               {.name = "apart"},
               {.name = "error"}},
              {}};
  const PublishedTable published("schroeder-table-6.2");
  for (std::size_t i = 0; i < published.rows(); ++i) {
    const double n = *published.number(i, "sources");
    if (n <= options.most_points) table.rows.push_back(divergence_row(i, n, timed_threads(options)));
  }
  return {table};
}

}  // namespace gaussdrift::reproduce
