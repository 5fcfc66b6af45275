// Tables 6.1 and 6.2 of [Sch06]: the divergence-free field S and its numerical divergence.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "field/divergence_free.hpp"
#include "study/fgtd_tables.hpp"
#include "study/measured_sum.hpp"
#include "study/point_sets.hpp"
#include "study/published_fgtd.hpp"

namespace gaussdrift::study {

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

int timed_threads(const FgtdOptions& options) { return options.threads > 0 ? options.threads : 1; }

}  // namespace

std::vector<Table> field_table(const FgtdOptions& options) {
  Table table{
      "6.1",
      "the field S(y): time and error",
      fmt::format("N = M Halton points, d = 3, sigma = 2, p = 9, nu = 3, every box, Gamma from Halton numbers{}; a "
                  "relative error hangs on the one target and component nearest to 0 and may be a power of ten off",
                  std::isinf(options.most_pairs)
                      ? ""
                      : fmt::format("; pair sums beyond {:.0e} pairs at a sample of the targets", options.most_pairs)),
      {{"pairs seconds", Quantity::seconds, 0, 3},
       {"fgtd seconds", Quantity::seconds, 0, 3, true},
       {"absolute", Quantity::error, 0, 1, true},
       {"relative", Quantity::error, 1, 1, true},
       {"times faster", Quantity::factor, 0, 3, true}},
      {}};
  for (const auto& then : published::table_61) {
    const double n = then.points;
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
    Row& row = table.rows.emplace_back();
    row.name = fmt::format("N = {:.0f}", n);
    row.entries = {{then.direct, direct, {}},
                   {then.seconds, hermite.seconds, automatic.seconds},
                   {then.absolute, hermite.absolute, automatic.absolute, kept},
                   {then.relative, hermite.relative, automatic.relative, kept},
                   {then.factor, direct / hermite.seconds, direct / automatic.seconds}};
    row.note = fmt::format("auto: tolerance {:.0e}", tolerance);
  }
  return {table};
}

std::vector<Table> divergence_table(const FgtdOptions& options) {
  Table table{
      "6.2",
      "numerical divergence of S",
      "at one target, (1/2, 1/2, 1/2); fgtd as the thesis has it: both terms of the proof of Lemma 6.4.1 are the "
      "same number, which the difference removes; rounding: the entries of Phi differentiated and summed apart, "
      "relative to the size of the terms",
      {{"pairs seconds", Quantity::seconds, 0, 3},
       {"pairs", Quantity::error, 0, 1},
       {"fgtd seconds", Quantity::seconds, 0, 3, true},
       {"fgtd", Quantity::error, 0, 1},
       {"pairs rounding", Quantity::error, 0, 1, false, false},
       {"fgtd rounding", Quantity::error, 0, 1, false, false}},
      {}};
  const fgtd::Points<3> target = Eigen::Vector3d::Constant(0.5);
  const int threads = timed_threads(options);
  for (const auto& then : published::table_62) {
    if (then.sources > options.most_points) continue;
    const auto count = static_cast<std::size_t>(then.sources);
    const fgtd::Points<3> points = halton_points<3>(count), cube = with_corners<3>(points);
    const Eigen::MatrixXd gamma = halton_coefficients(count), padded = with_corners(gamma);
    const auto divergence = [&](const fgtd::Points<3>& sources, const Eigen::MatrixXd& coefficients,
                                const GaussianSumOptions& with) {
      return GaussianSum<3>(sources, coefficients, sigma, with).divergence(GaussianMatrix::field, target);
    };
    const GaussianSumOptions direct_options{.derivative_order = 3, .method = fgtd::Method::direct, .threads = threads};
    Divergence direct, hermite, automatic;
    const double direct_seconds = fastest_seconds([&] { direct = divergence(points, gamma, direct_options); });
    const double hermite_seconds =
        fastest_seconds([&] { hermite = divergence(cube, padded, hermite_options(3, threads)); });
    const double automatic_seconds = fastest_seconds([&] {
      automatic = divergence(points, gamma, {.derivative_order = 3, .threads = threads, .expected_targets = 1});
    });

    // sum_i sum_{j != i} (d_iij s_j - d_jji s_i): d_iij s_j comes twice, once from row i and once from row j.
    const fgtd::Options as_published{
        .derivative_order = 3, .threads = threads, .hermite = hermite_options(3, threads).hermite};
    const fgtd::Plan<3> plan(cube, padded, sigma, as_published);
    double published_way = 0;
    for (std::size_t j = 0; j < 3; ++j)
      for (std::size_t i = 0; i < 3; ++i) {
        if (i == j) continue;
        fgtd::Derivative<3> alpha{};
        alpha[i] = 2, alpha[j] = 1;
        const Eigen::MatrixXd off_diagonal = plan.evaluate(target, alpha), diagonal = plan.evaluate(target, alpha);
        published_way += off_diagonal(0, static_cast<Index>(j)) - diagonal(0, static_cast<Index>(j));
      }

    const auto relative = [](const Divergence& result) { return std::abs(result.value[0]) / result.terms[0]; };
    Row& row = table.rows.emplace_back();
    row.name = fmt::format("N = {}", then.sources);
    row.entries = {{then.direct_seconds, direct_seconds, {}},
                   {then.direct, std::abs(direct.value[0]), {}},
                   {then.seconds, hermite_seconds, automatic_seconds},
                   {then.divergence, std::abs(published_way), {}},
                   {{}, relative(direct), {}},
                   {{}, relative(hermite), {}}};
  }
  return {table};
}

}  // namespace gaussdrift::study
