// Chooses the parameters r, p, n of `hermite`: the cheapest by prediction of all whose error is proven to keep the
// tolerance.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <ostream>

#include "fgtd/bounds.hpp"
#include "fgtd/boxes.hpp"
#include "fgtd/catalogue.hpp"
#include "fgtd/check.hpp"
#include "fgtd/cost.hpp"
#include "fgtd/hermite/hermite.hpp"

namespace fgtd::detail {
namespace {

constexpr double box_scales[] = {0.15, 0.25, 0.35, 0.45, 0.55, 0.65, 0.75, 0.85, 0.95};  // r < 1, where (3.5) lives
constexpr int largest_terms = 60;
constexpr double centre_rounding = 1.001;  // boxes_resolve(): sources lie within so many half sides of the centre

struct Decision {
  Choice choice;        // `boxes` is filled in later
  HermitePlan hermite;  // r, p, n
  double plan_bytes = 0;
};

/// The corners of the bounding box, [d][2].
template <int d>
Buffer<double> corners(const Situation<d>& at) {
  Buffer<double> points;
  for (std::size_t l = 0; l < d; ++l) {
    points.push_back(at.low[l]);
    points.push_back(at.low[l] + at.extent[l]);
  }
  return points;
}

/// How much slower the numbers of a box are if they exceed the first or the second cache. Measured in 3D and 4D with 8
/// to 130 thousand numbers a box, where the time was 2 to 6 times that within the cache. With this factor such
/// predictions are right to within a factor of 2.
double slowed_by_memory(double numbers) {
  constexpr double first_cache = 4096;
  return std::clamp(1 + 1.2 * std::log2(numbers / first_cache), 1.0, 6.0);
}

/// Predicted seconds of moments and evaluation. nodes: of the tree of sources; target_boxes: that scattered targets
/// occupy.
template <int d>
double hermite_seconds(const Situation<d>& at, double side, int p, double reach, const std::array<double, d>& nodes,
                       double target_boxes, double targets) {
  const double reach_distance = reach / std::sqrt(at.sigma);
  const double moments = std::pow(p, d);
  const double derivatives = at.options.derivative_order > 0 ? 2 : 1;
  double seconds = at.sources * (cost::point_sort + at.columns * moments * cost::moment_step) +
                   nodes[0] * at.columns * moments * cost::moment_number;
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
                 (rows * p * (std::max(8.0, window) * below) * cost::product_step + cost::product_call);
      seconds += nodes[l] * window * p * cost::hermite_value /
                 std::max(1.0, l + 1 < d ? nodes[l] / std::max(1.0, at.extent[l] / side) : 1.0);
      below *= hull;
    }
    return seconds + targets * at.columns * cost::grid_value;
  }
  const double near = boxes_within<d>(at, side, reach_distance, nodes[0]);
  const double a_box = std::max(1.0, targets / target_boxes);
  const double lanes = 8 * std::ceil(a_box / 8) / a_box;  // lanes paid for one used
  const double at_box = derivatives * at.columns * moments * cost::contract_step * slowed_by_memory(moments) +
                        d * (p + 8) * cost::hermite_value;
  return seconds + targets * (cost::point_sort + lanes * near * at_box);
}

/// The error that a summed box may have and still fade as promised. Beyond rho^2 = L a term may be off by tolerance
/// exp(L - rho^2). A summed box is off by exp(far error - |t|^2/2), with rho <= |t| + half a diagonal.
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
std::optional<Decision> by_hand(const Situation<d>& at) {
  const double targets = at.targets;
  const HermiteParameters& given = *at.options.hermite;
  Decision decision;
  decision.hermite = {given.box_scale, given.expansion_order, given.neighbours,
                      std::numeric_limits<double>::infinity()};
  Choice& choice = decision.choice;
  choice.bound = thesis_bound<d>(given.box_scale, given.expansion_order, given.neighbours, at.options.derivative_order);
  const double side = given.box_scale * std::sqrt(2 / at.sigma);
  if (!boxes_resolve<d>(corners<d>(at), 2, side)) return std::nullopt;
  const Occupation<d> seen = count_boxes<d>(at.sample, at.sample_count, side);
  std::array<double, d> nodes;
  for (std::size_t l = 0; l < d; ++l)
    nodes[l] = extrapolate(seen.nodes[l], static_cast<double>(at.sample_count), at.sources);
  const double sides = given.neighbours < 0 ? 1e9 : given.neighbours + 0.5;
  choice.seconds =
      hermite_seconds<d>(at, side, given.expansion_order, sides * side * std::sqrt(at.sigma), nodes,
                         extrapolate(seen.nodes[0], static_cast<double>(at.sample_count), targets), targets);
  choice.method = Method::hermite;
  choice.parameters =
      Hermite{.box_scale = given.box_scale,
              .box_side = side,
              .expansion_order = given.expansion_order,
              .neighbours = given.neighbours,
              .cost = thesis_cost<d>(at.sources, targets, given.expansion_order, given.neighbours, nodes[0])};
  return decision;
}

/// The cheapest r, p, n that keep the tolerance; none if none fits the memory limit.
template <int d>
std::optional<Decision> cheapest(const Situation<d>& at) {
  const double targets = at.targets;
  const double tolerance = at.options.tolerance;
  const int order = at.options.derivative_order;
  Decision best;
  best.choice.seconds = std::numeric_limits<double>::infinity();
  double smallest_memory = std::numeric_limits<double>::infinity();
  for (const double r : box_scales) {
    const double side = r * std::sqrt(2 / at.sigma);
    if (!boxes_resolve<d>(corners<d>(at), 2, side)) continue;
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

    // At the least every source has its moments and, if scattered, every target one box.
    const double moments = std::pow(p, d);
    const double least = at.sources * (cost::point_sort + at.columns * moments * cost::moment_step) +
                         (at.options.expected_grid ? 0 : targets * at.columns * moments * cost::contract_step);
    if (least >= std::min(at.to_beat, best.choice.seconds)) continue;

    const Occupation<d> seen = count_boxes<d>(at.sample, at.sample_count, side);
    std::array<double, d> nodes;
    for (std::size_t l = 0; l < d; ++l)
      nodes[l] = extrapolate(seen.nodes[l], static_cast<double>(at.sample_count), at.sources);
    const double memory = 8 * (nodes[0] * at.columns * std::pow(p, d) + at.sources * (2 * d + at.columns + 3));
    smallest_memory = std::min(smallest_memory, memory);
    if (memory > static_cast<double>(at.options.memory_limit)) continue;

    const double seconds = hermite_seconds<d>(
        at, side, p, reach, nodes, extrapolate(seen.nodes[0], static_cast<double>(at.sample_count), targets), targets);
    if (seconds >= best.choice.seconds) continue;
    best.hermite = {r, p, n, reach};
    best.plan_bytes = memory;
    Choice& choice = best.choice;
    choice.method = Method::hermite;
    choice.bound = std::max(kept_error(d, centre_rounding * r, p, order),
                            dropped_error(d, find_reach(d, tolerance, order), order));
    choice.seconds = seconds;
    choice.parameters = Hermite{.box_scale = r,
                                .box_side = side,
                                .expansion_order = p,
                                .neighbours = n,
                                .cost = thesis_cost<d>(at.sources, targets, p, n, nodes[0])};
  }
  if (best.choice.method == Method::hermite) return best;
  if (at.options.method == Method::hermite && std::isfinite(smallest_memory))
    check_memory("the plan with Method::hermite", smallest_memory, at.options.memory_limit);
  return std::nullopt;
}

template <int d>
std::optional<Proposal<d>> propose_hermite(const Situation<d>& at) {
  const std::optional<Decision> decision = at.options.hermite ? by_hand<d>(at) : cheapest<d>(at);
  if (!decision) return std::nullopt;
  Proposal<d> proposal;
  proposal.choice = decision->choice;
  proposal.plan_bytes = decision->plan_bytes;
  proposal.make = [plan = decision->hermite, sigma = at.sigma,
                   side = std::get<Hermite>(decision->choice.parameters).box_side,
                   threads = at.options.threads](Buffer<double> position) {
    const std::size_t count = position.size() / d;
    return std::make_unique<HermiteSum<d>>(plan, sigma, side, std::move(position), count, threads);
  };
  return proposal;
}

void print_hermite(std::ostream& out, const Choice& choice) {
  const Hermite& chosen = std::get<Hermite>(choice.parameters);
  out << ", box scale " << chosen.box_scale << " (side " << chosen.box_side << "), expansion order "
      << chosen.expansion_order << ", ";
  if (chosen.neighbours == HermiteParameters::all_boxes) {
    out << "all boxes";
  } else {
    out << chosen.neighbours << " neighbours";
  }
  out << ", " << chosen.boxes << " occupied boxes, cost by (3.5) " << chosen.cost;
}

std::vector<Parameter> list_hermite(const Choice& choice) {
  const Hermite& chosen = std::get<Hermite>(choice.parameters);
  std::vector<Parameter> list{{"box_scale", chosen.box_scale},
                              {"box_side", chosen.box_side},
                              {"expansion_order", std::int64_t{chosen.expansion_order}},
                              {"neighbours", std::int64_t{chosen.neighbours}},
                              {"boxes", static_cast<std::int64_t>(chosen.boxes)},
                              {"cost", chosen.cost}};
  if (chosen.neighbours == HermiteParameters::all_boxes) list[3].value = "all";
  return list;
}

}  // namespace

MethodEntry hermite_method() {
  return {.method = Method::hermite,
          .name = "hermite",
          .meaning = "the thesis's method: Hermite series of boxes of sources",
          .search_seconds = cost::hermite_search,
          .propose = {propose_hermite<1>, propose_hermite<2>, propose_hermite<3>, propose_hermite<4>},
          .print = print_hermite,
          .parameters = list_hermite};
}

}  // namespace fgtd::detail
