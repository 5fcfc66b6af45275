// Chooses the method and its parameters; see choose.hpp.
#include "fgtd/choose.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "fgtd/bounds.hpp"
#include "fgtd/boxes.hpp"
#include "fgtd/check.hpp"
#include "fgtd/cost.hpp"

namespace fgtd::detail {
namespace {

constexpr double box_scales[] = {0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95};  // r < 1, where (3.5) lives
constexpr int largest_terms = 60;
constexpr std::size_t sample_size = 8192;  // sources looked at to estimate how many boxes are occupied
constexpr double centre_rounding = 1.001;  // boxes_resolve(): sources lie within so many half sides of the centre

/// Sources of the sample and what a box costs to reach.
template <int d>
struct Situation {
  const Options& options;
  double sigma;
  double sources;
  double columns;
  std::vector<double> sample;  // [d][sample_count]
  std::size_t sample_count;
  std::array<double, d> extent{};  // of the sources
  std::array<double, d> low{};
};

template <int d>
Situation<d> look_at(const Sources<d>& sources, double sigma, const Options& options) {
  Situation<d> situation{options,
                         sigma,
                         static_cast<double>(sources.count),
                         static_cast<double>(std::max<std::size_t>(1, sources.columns)),
                         {},
                         std::min(sources.count, sample_size)};
  for (std::size_t l = 0; l < d; ++l) {
    const double* x = sources.position.data() + l * sources.count;
    const auto [low, high] = std::minmax_element(x, x + sources.count);
    situation.low[l] = *low;
    situation.extent[l] = *high - *low;
    for (std::size_t i = 0; i < situation.sample_count; ++i)
      situation.sample.push_back(x[i * sources.count / situation.sample_count]);
  }
  return situation;
}

/// Places occupied by `points` points that fall on equally likely places, of which `sampled` points occupied `seen`:
/// K (1 - exp(-sampled / K)) = seen is solved for K.
double extrapolate(double seen, double sampled, double points) {
  if (sampled >= points) return seen;
  double low = seen, high = 1e18;
  for (int step = 0; step < 100; ++step) {
    const double middle = std::sqrt(low * high);
    (-middle * std::expm1(-sampled / middle) < seen ? low : high) = middle;
  }
  return std::min(points, -high * std::expm1(-points / high));
}

/// Cubes of a lattice of unit cubes within `reach` of a random point: the volume of a cube widened by a ball.
double cubes_within(int d, double reach) {
  constexpr double pi = std::numbers::pi;
  constexpr double ball[] = {1, 2, pi, 4 * pi / 3, pi * pi / 2};
  double sum = 0, binomial = 1;
  for (int j = 0; j <= d; ++j) {
    sum += binomial * ball[j] * std::pow(reach, j);
    binomial = binomial * (d - j) / (j + 1);
  }
  return sum;
}

/// Predicted seconds of moments and evaluation.
template <int d>
double hermite_seconds(const Situation<d>& at, double side, int p, double reach, const std::array<double, d>& nodes,
                       double targets) {
  const double reach_distance = reach / std::sqrt(at.sigma);
  const double moments = std::pow(p, d);
  const double derivatives = at.options.derivative_order > 0 ? 2 : 1;
  double seconds = at.sources * (cost::source_sort + at.columns * moments * cost::moment_step);
  if (at.options.expected_grid) {
    // window[l]: nodes that one column of boxes reaches, hull[l]: nodes that all reach
    double below = 1;  // nodes of the axes before, as far as they are filled
    for (std::size_t l = 0; l < d; ++l) {
      const auto& axis = at.options.expected_grid->axes[l];
      const auto inside = [&](double low, double high) {
        return static_cast<double>(std::upper_bound(axis.begin(), axis.end(), high) -
                                   std::lower_bound(axis.begin(), axis.end(), low));
      };
      const double hull = inside(at.low[l] - reach_distance, at.low[l] + at.extent[l] + reach_distance);
      const double span = at.extent[l] + 2 * reach_distance;
      const double window = std::min(hull, span > 0 ? hull * (side + 2 * reach_distance) / span : hull);
      const double rows = std::pow(p, static_cast<double>(d - 1 - l));
      seconds += at.columns * derivatives * nodes[l] *
                 (rows * p * (std::max(8.0, window) * below) * cost::product_step + cost::window_call);
      seconds += nodes[l] * window * p * cost::hermite_value /
                 std::max(1.0, l + 1 < d ? nodes[l] / std::max(1.0, at.extent[l] / side) : 1.0);
      below *= hull;
    }
    return seconds;
  }
  const double near = std::min(nodes[0], cubes_within(d, reach_distance / side));
  const double a_box = std::max(1.0, targets / nodes[0]);
  const double lanes = 8 * std::ceil(a_box / 8) / a_box;  // lanes paid for one used
  const double at_box = derivatives * at.columns * moments * cost::contract_step + d * (p + 8) * cost::hermite_value;
  return seconds + targets * (cost::source_sort + lanes * near * at_box);
}

/// The error that a summed box may have so that it fades as promised: beyond rho^2 = L a term may be off by
/// tolerance exp(L - rho^2), and a summed box is off by exp(far error - |t|^2/2) with rho <= |t| + half a diagonal.
bool fades(int d, double r, int p, double farthest, double tolerance, int derivative_order) {
  const double limit = 2 * std::log(1 / tolerance) + 40;
  if (farthest * farthest <= limit) return true;
  const double half_diagonal = r * std::sqrt(0.5 * d);
  const double inner = farthest - half_diagonal;
  return log_far_error(d, r, p, derivative_order) - 0.5 * inner * inner <=
         std::log(tolerance) + limit - farthest * farthest;
}

template <int d>
double thesis_cost(double sources, double targets, int p, int n, double boxes) {
  return hermite_cost(d, p, n < 0 ? boxes : std::min(boxes, std::pow(2.0 * n + 1, d)), sources, targets);
}

template <int d>
Decision by_hand(const Situation<d>& at, double targets) {
  const HermiteParameters& given = *at.options.hermite;
  Decision decision;
  decision.hermite = {given.box_scale, given.expansion_order, given.neighbours,
                      std::numeric_limits<double>::infinity()};
  Choice& choice = decision.choice;
  choice.bound = thesis_bound<d>(given.box_scale, given.expansion_order, given.neighbours, at.options.derivative_order);
  choice.box_scale = given.box_scale;
  choice.box_side = given.box_scale * std::sqrt(2 / at.sigma);
  choice.expansion_order = given.expansion_order;
  choice.neighbours = given.neighbours;
  if (!boxes_resolve<d>(at.sample, at.sample_count, choice.box_side)) return decision;
  const Occupation<d> seen = count_boxes<d>(at.sample, at.sample_count, choice.box_side);
  std::array<double, d> nodes;
  for (std::size_t l = 0; l < d; ++l)
    nodes[l] = extrapolate(seen.nodes[l], static_cast<double>(at.sample_count), at.sources);
  const double sides = given.neighbours < 0 ? 1e9 : given.neighbours + 0.5;
  choice.seconds = hermite_seconds<d>(at, choice.box_side, given.expansion_order,
                                      sides * choice.box_side * std::sqrt(at.sigma), nodes, targets);
  choice.cost = thesis_cost<d>(at.sources, targets, given.expansion_order, given.neighbours, nodes[0]);
  choice.method = Method::hermite;
  return decision;
}

/// The cheapest r, p, n that keep the tolerance; the method is `direct` if none fits the memory limit.
template <int d>
Decision cheapest_hermite(const Situation<d>& at, double targets) {
  const double tolerance = at.options.tolerance;
  const int order = at.options.derivative_order;
  Decision best;
  best.choice.seconds = std::numeric_limits<double>::infinity();
  double smallest_memory = std::numeric_limits<double>::infinity();
  for (const double r : box_scales) {
    const double side = r * std::sqrt(2 / at.sigma);
    if (!boxes_resolve<d>(at.sample, at.sample_count, side)) continue;
    const double scaled_side = r * std::numbers::sqrt2;
    const double reach = find_reach(d, tolerance, order) + 2e-3 * scaled_side * std::sqrt(d);
    const double diagonal = scaled_side * std::sqrt(d);
    const double farthest = centre_rounding * (diagonal + (at.options.expected_grid ? std::sqrt(d) : 1.0) * reach);
    const double farthest_on_grid = centre_rounding * (diagonal + std::sqrt(d) * reach);
    int p = 1;
    while (p <= largest_terms && kept_error(d, centre_rounding * r, p, order) > tolerance) ++p;
    while (p <= largest_terms && !(fades(d, centre_rounding * r, p, farthest, tolerance, order) &&
                                   fades(d, centre_rounding * r, p, farthest_on_grid, tolerance, order)))
      ++p;
    if (p > largest_terms) continue;
    const int n = static_cast<int>(std::ceil(reach / scaled_side));

    const Occupation<d> seen = count_boxes<d>(at.sample, at.sample_count, side);
    std::array<double, d> nodes;
    for (std::size_t l = 0; l < d; ++l)
      nodes[l] = extrapolate(seen.nodes[l], static_cast<double>(at.sample_count), at.sources);
    const double memory = 8 * (nodes[0] * at.columns * std::pow(p, d) + at.sources * (2 * d + at.columns + 3));
    smallest_memory = std::min(smallest_memory, memory);
    if (memory > static_cast<double>(at.options.memory_limit)) continue;

    const double seconds = hermite_seconds<d>(at, side, p, reach, nodes, targets);
    if (seconds >= best.choice.seconds) continue;
    best.hermite = {r, p, n, reach};
    Choice& choice = best.choice;
    choice.method = Method::hermite;
    choice.bound = std::max(kept_error(d, centre_rounding * r, p, order),
                            dropped_error(d, find_reach(d, tolerance, order), order));
    choice.cost = thesis_cost<d>(at.sources, targets, p, n, nodes[0]);
    choice.seconds = seconds;
    choice.box_scale = r;
    choice.box_side = side;
    choice.expansion_order = p;
    choice.neighbours = n;
  }
  if (best.choice.method == Method::direct && at.options.method == Method::hermite && std::isfinite(smallest_memory)) {
    check_memory("the plan with Method::hermite", smallest_memory, at.options.memory_limit);
  }
  return best;
}

}  // namespace

template <int d>
Decision choose(const Sources<d>& sources, double sigma, const Options& options) {
  const double count = static_cast<double>(sources.count);
  double targets = static_cast<double>(options.expected_targets);
  if (options.expected_grid) targets = static_cast<double>(options.expected_grid->size());
  if (targets == 0) targets = count;

  Decision direct;
  direct.choice.method = Method::direct;
  direct.choice.bound = 0;
  direct.choice.cost = count * targets;
  direct.choice.seconds = direct.choice.cost * cost::direct_pair[d - 1] *
                          static_cast<double>(std::max<std::size_t>(1, sources.columns)) *
                          (options.derivative_order > 0 ? cost::direct_derivative_factor : 1);

  Decision decision = direct;
  if (sources.count > 0 && options.hermite) {
    decision = by_hand<d>(look_at(sources, sigma, options), targets);
  } else if (sources.count > 0 && options.method != Method::direct) {
    decision = cheapest_hermite<d>(look_at(sources, sigma, options), targets);
    if (options.method == Method::automatic && !(decision.choice.seconds < direct.choice.seconds)) decision = direct;
  }
  if (decision.choice.method == Method::direct) decision = direct;
  decision.choice.tolerance = options.hermite ? 0 : options.tolerance;
  decision.choice.sources = sources.count;
  decision.choice.targets = static_cast<std::size_t>(targets);
  return decision;
}

template Decision choose<1>(const Sources<1>&, double, const Options&);
template Decision choose<2>(const Sources<2>&, double, const Options&);
template Decision choose<3>(const Sources<3>&, double, const Options&);
template Decision choose<4>(const Sources<4>&, double, const Options&);

}  // namespace fgtd::detail
