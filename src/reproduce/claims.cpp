#include "reproduce/claims.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/stopwatch.hpp"
#include "fgtd/fgtd.hpp"
#include "gaussdrift/error.hpp"
#include "reproduce/cone.hpp"
#include "reproduce/measured_sum.hpp"
#include "reproduce/point_sets.hpp"
#include "reproduce/published.hpp"

namespace gaussdrift::reproduce {

namespace {

using Index = Eigen::Index;
constexpr int all_boxes = fgtd::HermiteParameters::all_boxes;

/// The printed numbers by name; each belongs to a section.
class Printed {
 public:
  double operator()(const std::string& claim) const { return *table_.number(row(claim), "printed"); }
  const std::string& text(const std::string& claim) const { return table_.text(row(claim), "printed"); }
  const std::string& section(const std::string& claim) const { return table_.text(row(claim), "section"); }

 private:
  std::size_t row(const std::string& claim) const {
    for (std::size_t i = 0; i < table_.rows(); ++i)
      if (table_.row_name(i) == claim) return i;
    throw Error(ExitCode::internal, "there is no published claim " + claim);
  }
  PublishedTable table_{"schroeder-text"};
};

/// The error of what n neighbour boxes leave out, without derivatives [Sch06, Bemerkung 3.7.6], for a weight of 1.
double box_error(double r, double n) { return std::exp(-2 * r * r * n * n); }
/// The least n for an error of 10^-k [Sch06, 3.8.2].
double neighbours_for(double r, double k) { return std::ceil(std::sqrt(k * std::numbers::ln10 / (2 * r * r))); }

/// A source and a target at the borders of their boxes, n boxes apart: what `hermite` leaves away there.
double measured_box_error(double r, int n) {
  const double sigma = 1, side = r * std::sqrt(2 / sigma), inside = 1e-9 * side;
  const fgtd::Points<1> sources{{0.0, (n + 1) * side + inside, (n + 2) * side}};  // the outer ones set the boxes
  Eigen::MatrixXd weights = Eigen::MatrixXd::Zero(3, 1);
  weights(1, 0) = 1;
  const fgtd::Points<1> target{{side - inside}};
  const fgtd::Plan<1> direct(sources, weights, sigma, {.method = fgtd::Method::direct});
  fgtd::Options options;
  options.hermite = fgtd::HermiteParameters{.box_scale = r, .expansion_order = 16, .neighbours = n};
  const fgtd::Plan<1> hermite(sources, weights, sigma, options);
  return std::abs(hermite.evaluate(target)(0, 0) - direct.evaluate(target)(0, 0));
}

struct Choice {
  double cost = std::numeric_limits<double>::infinity(), bound = 0;
  int p = 0, nu = 0;
};

/// The cheapest p and nu whose bound for d = 3, sigma = 2, alpha = 0, Q = 1 is below `error`. Only those of Tables 3.2
/// and 3.3 are tried or, without that limit, many more.
Choice cheapest(double error, bool of_tables) {
  Choice best;
  for (int nu = 2; nu <= (of_tables ? 4 : 10); ++nu)
    for (int p = 5; p <= (of_tables ? 12 : 30); ++p) {
      const double cost = fgtd::hermite_cost(3, p, std::pow(nu, 3), 1, 1);
      const double bound = fgtd::hermite_bound<3>(1.0 / nu, p, all_boxes, {}).value();
      if (bound < error && cost < best.cost) best = {cost, bound, p, nu};
    }
  return best;
}

/// The density of the cone at t = 0 on a grid over the domain, pair by pair and by `hermite`.
class ConeDensity {
 public:
  ConeDensity(int particles_an_axis, double overlap, int points_an_axis, int threads) : threads_(threads) {
    const Cone cone = seed_cone(particles_an_axis, threads);
    spacing_ = cone.seeding.spacing;
    width_ = overlap * spacing_;
    weight_ = cone.particles.alpha;
    const auto count = static_cast<Index>(cone.particles.size());
    // Two sources without weight make the domain the bounding box, as in the thesis.
    sources_.resize(2, count + 2);
    sources_.rightCols(2) << -1, 1, -1, 1;
    weights_ = Eigen::MatrixXd::Zero(count + 2, 1);
    for (Index j = 0; j < count; ++j) {
      const auto k = static_cast<std::size_t>(j);
      sources_.col(j) << cone.particles.position[0][k], cone.particles.position[1][k];
      weights_(j, 0) = weight_[k] / (std::numbers::pi * width_ * width_);
    }
    targets_ = grid_points<2>(static_cast<std::size_t>(points_an_axis), 2.0 / (points_an_axis - 1));
    targets_.array() -= 1;
    const fgtd::Plan<2> direct(sources_, weights_, sigma(), {.method = fgtd::Method::direct, .threads = threads});
    direct_seconds = fastest_seconds([&] { exact_ = direct.evaluate(targets_); });
  }

  double direct_seconds = 0;
  double spacing() const { return spacing_; }
  double total() const { return weights_.sum(); }  // Q
  std::size_t particles_above(double least) const {
    return static_cast<std::size_t>(
        std::count_if(weight_.begin(), weight_.end(), [least](double alpha) { return alpha > least; }));
  }

  struct Measured {
    double error = 0, seconds = 0;
  };
  Measured hermite(double r, int p, int n) const {
    fgtd::Options options;
    options.threads = threads_;
    options.hermite = fgtd::HermiteParameters{.box_scale = r, .expansion_order = p, .neighbours = n};
    Measured result;
    Eigen::MatrixXd values;
    result.seconds =
        fastest_seconds([&] { values = fgtd::Plan<2>(sources_, weights_, sigma(), options).evaluate(targets_); });
    const Eigen::ArrayXXd error = (values - exact_).array().abs();
    result.error = error.allFinite() ? error.maxCoeff() : std::numeric_limits<double>::infinity();
    return result;
  }

 private:
  double sigma() const { return 1 / (width_ * width_); }

  int threads_;
  double spacing_ = 0, width_ = 0;
  std::vector<double> weight_;  // alpha_j
  fgtd::Points<2> sources_, targets_;
  Eigen::MatrixXd weights_, exact_;
};

/// Numbers of chapters 3 and 4 that follow from a formula.
void formulas(const Printed& printed, std::vector<Claim>& claims) {
  constexpr double p = 8, n = 2, sources = 10000, boxes = (2 * n + 1) * (2 * n + 1);
  const double even = std::ceil(p * p * sources / (sources - boxes * p * p));
  claims.push_back(
      {printed.section("break_even"), "break-even",
       "least number of evaluations for which the transform of 10 000 sources pays, with p = 8, n = 2, d = 2: p^d N / "
       "(N - (2n+1)^d p^d)",
       printed.text("break_even"), even, even == printed("break_even"), "by arithmetic"});
  for (const auto& [name, terms, nu] :
       {std::tuple{"factor_of_the_bound_p8_nu2", 8, 2}, {"factor_of_the_bound_p9_nu3", 9, 3}}) {
    const double factor = fgtd::hermite_bound<3>(1.0 / nu, terms, all_boxes, {0, 1, 2}).value() * std::pow(2.0, 1.5);
    claims.push_back(
        {printed.section(name), fmt::format("bound, nu = {}", nu),
         fmt::format("(3.5) over Q for p = {}, nu = {}, alpha = (0,1,2), sigma = 2, as a power of ten", terms, nu),
         printed.text(name), factor, std::floor(std::log10(factor)) == std::round(std::log10(printed(name))),
         "by arithmetic; the bounds of Table 4.1 are smaller than this factor times Q"});
  }
  const double r = std::sqrt(10000.0 / 2) / 4;
  claims.push_back({printed.section("box_scale_of_10000"), "r of 10 000",
                    "r of 4 boxes an axis for sigma = 10 000: sqrt(sigma/2)/4", printed.text("box_scale_of_10000"), r,
                    std::abs(r - printed("box_scale_of_10000")) <= 0.5e-4,
                    "by arithmetic; (3.5) says nothing for r >= 1"});
  const double grids = fgtd::hermite_bound<2>(0.25, 9, 20, {}).value();
  claims.push_back({printed.section("error_of_grids"), "error of grids",
                    "error below Q 1e-8 for p = 9, r = 0.25, n = 20, d = 2, alpha = 0 by (3.5), over Q",
                    printed.text("error_of_grids"), grids, grids < printed("error_of_grids"),
                    "it is of that order, but not below. Measured errors are far smaller (Table 4.7)"});
}

void boxes_left_out(const Printed& printed, std::vector<Claim>& claims) {
  const double r = printed("box_scale"), n = printed("neighbours_of_figures");
  const double bound = box_error(r, n), left = measured_box_error(r, static_cast<int>(n));
  claims.push_back(
      {"3.7.6", "box error",
       fmt::format("without derivatives, n boxes leave out at most exp(-2 r^2 n^2) of a weight (r = {:g}, n = {:g}). "
                   "Measured with a source at the border of the first box that is left out",
                   r, n),
       fmt::format("{:.3g}", bound), left, left <= bound && left > 0.999 * bound,
       fmt::format("no smaller bound is true. (3.5) promises exp(-r^2 n^2) = {:.2g}", std::sqrt(bound))});
}

void cheapest_parameters(const Printed& printed, std::vector<Claim>& claims) {
  const double error = printed("optimum_error");
  const auto p = static_cast<int>(printed("optimum_terms")), nu = static_cast<int>(printed("optimum_boxes"));
  const double cost = fgtd::hermite_cost(3, p, std::pow(nu, 3), 1, 1);
  const double promised = fgtd::hermite_bound<3>(1.0 / nu, p, all_boxes, {}).value();
  const Choice same = cheapest(10 * error, true), below = cheapest(error, false);
  const std::string section = printed.section("optimum_terms");
  claims.push_back(
      {section, "optimum",
       fmt::format("p = {}, nu = {} cost least, {:g} terms, of all parameters with an error below {:g}. "
                   "Computed is the least cost of Table 3.2 with the power of ten 1e-7 in Table 3.3",
                   p, nu, cost, error),
       fmt::format("{:g}", cost), same.cost, same.p == p && same.nu == nu,
       fmt::format("by the thesis's own tables p = {}, nu = {} cost less and err less: (3.5) gives {:.2g} "
                   "there and {:.2g} for p = {}, nu = {}. Neither is below {:g}. The cheapest parameters "
                   "below it are p = {}, nu = {} with {:g} terms. By time p = {}, nu = {} is faster (Table 3.5)",
                   same.p, same.nu, same.bound, promised, p, nu, error, below.p, below.nu, below.cost, p, nu)});
}

void neighbours_that_suffice(const Printed& printed, std::vector<Claim>& claims) {
  const double r = printed("box_scale");
  const auto enough = [&](const char* neighbours, const char* wanted, const char* name) {
    const double taken = printed(neighbours), digits = -std::log10(printed(wanted));
    const double needed = neighbours_for(r, digits);
    claims.push_back(
        {printed.section(neighbours), name,
         fmt::format(
             "n = {:g} neighbour boxes suffice for an error of 1e-{:.0f} (r = {:g}). Computed is the least n by 3.8.2",
             taken, digits, r),
         printed.text(neighbours), needed, taken >= needed,
         fmt::format("n = {:g} leaves out at most {:.1e}", taken, box_error(r, taken))});
  };
  enough("neighbours_of_tables", "error_of_tables", "n of the tables");
  enough("neighbours_of_figures", "error_of_figures", "n of the figures");
}

// With weights 1/N, Q is 1 whatever N is.
void error_of_any_number(const Printed& printed, std::vector<Claim>& claims) {
  const auto p = static_cast<int>(printed("optimum_terms")), nu = static_cast<int>(printed("optimum_boxes"));
  std::vector<double> errors;
  for (const std::size_t count : {std::size_t{1000}, std::size_t{8000}}) {
    const Problem<3> problem{halton_points<3>(count),
                             Eigen::MatrixXd::Constant(static_cast<Index>(count), 1, 1.0 / static_cast<double>(count)),
                             2.0,
                             {}};
    errors.push_back(MeasuredSum<3>(problem, 500, 0, 1).hermite(nu, p, all_boxes).absolute);
  }
  const double ratio = errors[1] / errors[0];
  claims.push_back(
      {"3.8.2", "constant error",
       fmt::format("with weights 1/N the error does not depend on N (p = {}, nu = {}, sigma = 2). Computed is "
                   "the error of 8000 Halton points over that of 1000",
                   p, nu),
       "constant", ratio, ratio > 1.0 / 3 && ratio < 3,
       fmt::format("the errors are {:.2g} and {:.2g}. The bound is the same for all N", errors[0], errors[1])});
}

void numbers_of_boxes(const Printed& printed, std::vector<Claim>& claims) {
  for (const auto& [name, d] : {std::pair{"boxes_for_32_in_the_plane", 2}, {"boxes_for_32_in_space", 3}}) {
    const double boxes = std::pow(32, d);
    claims.push_back({printed.section(name), fmt::format("boxes, d = {}", d),
                      fmt::format("nu = 32 makes more boxes than printed, d = {}", d), printed.text(name), boxes,
                      boxes > printed(name), "by arithmetic"});
  }
}

void choice_of_parameters(const Printed& printed, std::vector<Claim>& claims) {
  boxes_left_out(printed, claims);
  cheapest_parameters(printed, claims);
  neighbours_that_suffice(printed, claims);
  error_of_any_number(printed, claims);
  numbers_of_boxes(printed, claims);
}

/// The thesis's cone, and what it says of it in one section.
struct RotatingCone {
  RotatingCone(const Printed& values, const ClaimsOptions& options)
      : printed(values),
        per_axis(static_cast<int>(printed("particles_an_axis"))),
        points(options.points_an_axis > 0 ? options.points_an_axis : static_cast<int>(printed("points_of_figures"))),
        overlap(printed("overlap")),
        r(printed("box_scale")),
        p(static_cast<int>(printed("terms"))),
        section(printed.section("particles_with_weight")),
        cone(per_axis, overlap, points, options.threads) {}

  void lattice(std::vector<Claim>& claims) const;
  void tables(std::vector<Claim>& claims) const;
  void figures(std::vector<Claim>& claims) const;

  const Printed& printed;
  const int per_axis, points;
  const double overlap, r;
  const int p;
  const std::string section;
  const ConeDensity cone;
};

void RotatingCone::lattice(std::vector<Claim>& claims) const {
  const auto particles = static_cast<double>(cone.particles_above(1e-15));
  claims.push_back(
      {section, "particles",
       fmt::format("number of particles on the lattice of {} x {} with alpha_j not 0. Computed are those above 1e-15",
                   per_axis, per_axis),
       printed.text("particles_with_weight"), particles, particles == printed("particles_with_weight"),
       fmt::format("{} are not 0. The particles between lie at the rim of the cone", cone.particles_above(0))});

  // As in Table 4.7, the number is that of a cube of side 1 and cut off.
  const double exact = 1 / (r * std::sqrt(2.0) * overlap * cone.spacing()), boxes = std::floor(exact);
  claims.push_back(
      {section, "boxes an axis",
       fmt::format("number of boxes an axis for r = {:g}, c = {:g}: 1/(r sqrt(2) c h), rounded down", r, overlap),
       printed.text("boxes_an_axis"), boxes, boxes == printed("boxes_an_axis"),
       fmt::format("that is for a cube of side 1. The domain has side 2, so it has {:.0f} boxes of this r",
                   std::ceil(2 * exact))});
}

void RotatingCone::tables(std::vector<Claim>& claims) const {
  const auto wide = static_cast<int>(printed("neighbours_of_tables"));
  const double bound = fgtd::hermite_bound<2>(r, p, all_boxes, {}).value() + box_error(r, wide);
  claims.push_back(
      {section, "error of the tables",
       fmt::format("the error for r = {:g}, p = {}, n = {} is below Q 1e-18. Computed is (3.5) with 3.7.6, over Q", r,
                   p, wide),
       printed.text("error_of_tables"), bound, bound < printed("error_of_tables"),
       "the series alone may err by that. It is of that order, but not below"});
  const auto measured = cone.hermite(r, p, wide);
  claims.push_back({section,
                    "measured so",
                    fmt::format("the same error, measured at t = 0 at {} x {} points, over Q", points, points),
                    "",
                    measured.error / cone.total(),
                    {},
                    "this is rounding: sums in double precision cannot show 1e-18"});
}

void RotatingCone::figures(std::vector<Claim>& claims) const {
  const auto narrow = static_cast<int>(printed("neighbours_of_figures"));
  const auto measured = cone.hermite(r, p, narrow);
  claims.push_back(
      {section, "error of the figures",
       fmt::format("the error for r = {:g}, p = {}, n = {} is 1e-8. Measured at t = 0, where the height is 1", r, p,
                   narrow),
       printed.text("error_of_figures"), measured.error, measured.error <= printed("error_of_figures"),
       "by 3.8.2 this n is too small for this r, as above"});
  // The printed boxes put over the domain are twice as wide as stated: r is then 0.4.
  const double over_domain = 2 / printed("boxes_an_axis") / (std::sqrt(2.0) * overlap * cone.spacing());
  const auto with_printed = cone.hermite(over_domain, p, narrow);
  claims.push_back(
      {section, "difference from pairs",
       fmt::format("with n = {} the result differs from pair by pair only in the 12th decimal. Computed with "
                   "the {} boxes over the domain of side 2, so r = {:.3g}",
                   narrow, printed.text("boxes_an_axis"), over_domain),
       printed.text("difference_from_pairs"), with_printed.error,
       with_printed.error <= printed("difference_from_pairs"),
       fmt::format("with r = {:g} as stated it differs by {:.1e}. So the thesis probably had the wider boxes", r,
                   measured.error)});
  claims.push_back({section,
                    "seconds, n = 12",
                    fmt::format("seconds of {} x {} points by hermite, r = {:.3g}", points, points, over_domain),
                    printed.text("seconds_of_figures"),
                    with_printed.seconds,
                    {},
                    "another machine"});
  claims.push_back({section,
                    "seconds, pairs",
                    fmt::format("seconds of {} x {} points pair by pair", points, points),
                    printed.text("seconds_of_pairs"),
                    cone.direct_seconds,
                    {},
                    "another machine"});
}

}  // namespace

ClaimsReproduction reproduce_claims(const ClaimsOptions& options,
                                    const std::function<void(const std::string&)>& progress) {
  const base::Stopwatch watch;
  const Printed printed;
  ClaimsReproduction result;
  formulas(printed, result.claims);
  choice_of_parameters(printed, result.claims);
  if (progress) progress("the rotating cone");
  const RotatingCone cone(printed, options);
  cone.lattice(result.claims);
  cone.tables(result.claims);
  cone.figures(result.claims);
  std::stable_sort(result.claims.begin(), result.claims.end(),
                   [](const Claim& a, const Claim& b) { return a.section < b.section; });
  result.seconds = watch.seconds();
  return result;
}

namespace {

std::string shown(double value) {
  const bool whole = value == std::round(value) && value < 1e7;
  return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.{}g}", value, value > 1 ? 6 : 3);
}

}  // namespace

std::string to_text(const ClaimsReproduction& result) {
  std::string text =
      "claims of the text of Schroeder 2006 outside its tables: section, claim, printed number, computed number\n\n";
  std::size_t hold = 0, fail = 0;
  for (const Claim& claim : result.claims) {
    const char* verdict = !claim.holds ? "" : *claim.holds ? "holds" : "does not hold";
    if (claim.holds) ++(*claim.holds ? hold : fail);
    text += fmt::format("{:<6} {:<22} {:>10} {:>10}  {}\n       {}\n", claim.section, claim.name,
                        claim.printed.empty() ? "-" : claim.printed, shown(claim.computed), verdict, claim.what);
    if (!claim.note.empty()) text += "       " + claim.note + "\n";
  }
  return text + fmt::format("\n{} claims hold. {} do not hold, and the last line of each gives the reason. {:.1f} s\n",
                            hold, fail, result.seconds);
}

std::string to_json(const ClaimsReproduction& result) {
  nlohmann::ordered_json claims = nlohmann::ordered_json::array();
  for (const Claim& claim : result.claims) {
    nlohmann::ordered_json holds = nullptr;
    if (claim.holds) holds = *claim.holds;
    claims.push_back({{"section", claim.section},
                      {"name", claim.name},
                      {"what", claim.what},
                      {"printed", claim.printed},
                      {"computed", claim.computed},
                      {"holds", holds},
                      {"note", claim.note}});
  }
  const nlohmann::ordered_json document{
      {"source", "Schroeder 2006, sections 3.7, 3.8 and 5.3.5"}, {"claims", claims}, {"seconds", result.seconds}};
  return document.dump(2) + "\n";
}

}  // namespace gaussdrift::reproduce
