// The cells of `cells` and `outer_product`: how far a Gaussian counts, the side by prediction of cost, and the two proposals.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <ostream>
#include <utility>

#include "fgtd/bounds.hpp"
#include "fgtd/catalogue.hpp"
#include "fgtd/cells/cost.hpp"
#include "fgtd/cells/job.hpp"
#include "fgtd/cells/sum.hpp"
#include "fgtd/check.hpp"

namespace fgtd::detail {
namespace {

constexpr int spans[] = {1, 2, 3, 4, 6, 8, 12};
constexpr double side_slack = 1.001;  // sides are longer than a fraction of the reach by what rounding may take away

/// Sides that coordinates can tell apart: every |x| is at most 2^36 sides, so that rounding moves a point by less than
/// side/16000.
template <int d>
double smallest_side(const Situation<d>& at) {
  double largest = 0;
  for (std::size_t l = 0; l < d; ++l)
    largest = std::max({largest, std::abs(at.low[l]), std::abs(at.low[l] + at.extent[l])});
  return largest * 0x1p-36;
}

/// The shortest exponential of which `factors` in a term take no more than half of the tolerance.
const Exponential& shortest_exponential(double tolerance, int factors) {
  const Exponential* chosen = exponentials;
  while (factors * chosen->error > 0.5 * tolerance) ++chosen;  // the last has none
  return *chosen;
}

/// The reach and the exponentials that keep the tolerance. A term is either summed, with the error of the exponential,
/// or dropped.
template <int d>
double find_precision(const Situation<d>& at, CellsPlan& plan) {
  const double tolerance = at.options.tolerance;
  const int order = at.options.derivative_order;
  plan.reach = find_reach(d, tolerance, order);
  const Exponential &pair = shortest_exponential(tolerance, 1), &row = shortest_exponential(tolerance, d);
  plan.degree = pair.degree;
  plan.row_degree = row.degree;
  return std::max({pair.error, d * row.error, dropped_error(d, plan.reach, order)});
}

/// Times that the exponential of a pair is computed: for so many columns of weights, or outputs of derivatives, at
/// once.
template <int d>
double exponentials_of_pair(const Situation<d>& at) {
  return std::ceil(at.columns / (at.options.derivative_order > 0 ? 16 : 4));
}

/// Sources within reach of a target that lies like the sources but is none of them, estimated from a part of the
/// sample.
template <int d>
double sources_around(const Situation<d>& at, double reach) {
  const std::size_t centres = std::min<std::size_t>(at.sample_count, 48);
  std::size_t within = 0;
  for (std::size_t c = 0; c < centres; ++c) {
    const std::size_t i = c * at.sample_count / centres;
    for (std::size_t j = 0; j < at.sample_count; ++j) {
      double squared = 0;
      for (std::size_t l = 0; l < d; ++l) {
        const double apart = at.sample[l * at.sample_count + i] - at.sample[l * at.sample_count + j];
        squared += apart * apart;
      }
      within += squared <= reach * reach ? 1 : 0;
    }
    --within;  // itself
  }
  const double looked_at =
      static_cast<double>(centres) * static_cast<double>(std::max<std::size_t>(1, at.sample_count - 1));
  return std::max(0.5 * at.sources / looked_at, at.sources * static_cast<double>(within) / looked_at);
}

/// Volume of the unit ball.
template <int d>
constexpr double ball = d == 1   ? 2.0
                        : d == 2 ? 3.141592653589793
                        : d == 3 ? 4.18879020478639
                                 : 4.934802200544679;

/// Seconds for scattered targets if `around` sources are within reach and cells have the side reach / span.
template <int d>
double points_seconds(const Situation<d>& at, double around, int span) {
  const double density = around / ball<d>;  // sources in a cube of the reach
  const double lines = std::min(std::pow(2 * span + 1, d - 1), 1 + at.sources);
  const double near = std::min(
      at.sources, 1 + density * std::min(std::pow(2.0 + 1.0 / span, d), ball<d> * std::pow(1 + 0.8 / span, d)));
  // Along a line of 2 span + 1 cells that see a target, the next target is `gap` cells away; four of them share a
  // vector, or one is alone in it.
  const double gap = at.sources / (at.targets * density * std::pow(span, -d));
  const double widening = 1 + 3 * gap / (2 * span + 1);
  const double pairs = near * std::min(widening, 4.0);
  const double targets_together = widening < 4 ? 4 : 1;
  const double pair =
      cost::cells_pair[d - 1] *
      (exponentials_of_pair<d>(at) * (at.options.derivative_order > 0 ? cost::cells_derivative_factor : 1) +
       cost::cells_column * (at.columns - 1));
  return at.sources * cost::cells_source_sort +
         at.targets * (cost::cells_target_sort + pairs * pair + lines * cost::cells_line / targets_together);
}

/// Nodes of an axis that sources within [low - reach, high + reach] see, and how many lie in a window of unit length.
struct AxisView {
  double nodes, density;
};

template <int d>
std::array<AxisView, d> view_grid(const Situation<d>& at, double reach) {
  std::array<AxisView, d> view;
  for (std::size_t l = 0; l < d; ++l) {
    const auto& axis = at.options.expected_grid->axes[l];
    const double nodes =
        static_cast<double>(std::upper_bound(axis.begin(), axis.end(), at.low[l] + at.extent[l] + reach) -
                            std::lower_bound(axis.begin(), axis.end(), at.low[l] - reach));
    view[l] = {nodes, nodes / std::max(at.extent[l] + 2 * reach, std::numeric_limits<double>::min())};
  }
  return view;
}

/// Seconds for the expected grid with cells of the side reach / span.
template <int d>
double grid_seconds(const Situation<d>& at, double reach, double side, const std::array<AxisView, d>& view) {
  double cells = 1;
  for (std::size_t l = 0; l < d; ++l) cells *= 1 + at.extent[l] / side;
  double groups = cells < 1e15 ? -cells * std::expm1(-at.sources / cells) : at.sources;
  groups = std::max(groups, at.sources / static_cast<double>(outer_product_depth));
  const double depth = at.sources / groups;
  const double orders = 1 + at.options.derivative_order;
  double window = 1, rows = 1, tables = 0;
  for (std::size_t l = 0; l < d; ++l) {
    const double nodes = std::min(view[l].nodes, 1 + view[l].density * (2 * reach + side * (depth - 1) / (depth + 1)));
    const double whole = l == 0 ? 8 * std::ceil(nodes / 8) * depth : 8 * std::ceil(depth / 8) * nodes;
    tables += orders * whole;
    window *= l == 0 ? 8 * std::ceil(nodes / 8) : nodes;
    if (l > 0) rows *= nodes;
  }
  if (d == 3) window *= 0.85;  // slabs leave out what is beyond the reach
  if (d == 4) window *= 0.7;
  const double parts = at.columns * (at.options.derivative_order > 0 ? 2 : 1);
  return at.sources * cost::outer_product_source_sort + at.targets * at.columns * cost::outer_product_value +
         groups * (cost::outer_product_group + tables * cost::outer_product_table +
                   parts * (window * (depth * cost::outer_product_step + cost::outer_product_update) +
                            rows * 8 * std::ceil(depth / 8) * cost::outer_product_row));
}

/// Chooses the cells for the expected targets. None if coordinates are so large that cells cannot be numbered.
template <int d>
std::optional<Proposal<d>> propose(const Situation<d>& at, Method method) {
  Proposal<d> proposal;
  for (const double length : at.extent)
    if (!std::isfinite(length)) return std::nullopt;
  CellsPlan plan;
  proposal.choice.bound = find_precision<d>(at, plan);
  const double reach = plan.reach / std::sqrt(at.sigma);
  const double smallest = std::max(smallest_side<d>(at), std::numeric_limits<double>::min());
  if (!(reach > 0) || !std::isfinite(2 * at.sigma) || !std::isfinite(2 * reach * reach))
    return std::nullopt;  // the kernel takes sigma log2 e times squares of distances

  double around = 0;
  std::array<AxisView, d> view{};
  if (at.options.expected_grid) {
    view = view_grid<d>(at, reach);
  } else {
    around = sources_around<d>(at, reach);
  }
  double best = std::numeric_limits<double>::infinity();
  for (const int span : spans) {
    const double side = side_slack * reach / span;
    if (span > 1 && side < smallest) break;
    const double seconds =
        at.options.expected_grid ? grid_seconds<d>(at, reach, side, view) : points_seconds<d>(at, around, span);
    if (seconds >= best) continue;
    best = seconds;
    plan.side = std::max(side, smallest);
    plan.span = span;
  }

  const double columns = at.columns;
  // positions, weights, order, and at worst a cell for every source; while they are sorted, also what the sort takes
  proposal.plan_bytes = 8 * at.sources * (d + columns) + 8 * at.sources * (3 * d + 7);
  if (proposal.plan_bytes > static_cast<double>(at.options.memory_limit)) {
    if (at.options.method == method)
      check_memory(method == Method::cells ? "the plan with Method::cells" : "the plan with Method::outer_product",
                   proposal.plan_bytes, at.options.memory_limit);
    return std::nullopt;
  }
  proposal.choice.method = method;
  proposal.choice.seconds = best;
  if (method == Method::cells)
    proposal.choice.parameters = Cells{.side = plan.side, .within_reach = plan.span};
  else
    proposal.choice.parameters = OuterProduct{.side = plan.side, .within_reach = plan.span};
  proposal.make = [plan, sigma = at.sigma, threads = at.options.threads](Buffer<double> position) {
    const std::size_t count = position.size() / d;
    return std::make_unique<CellsSum<d>>(plan, sigma, std::move(position), count, threads);
  };
  return proposal;
}

template <int d>
std::optional<Proposal<d>> propose_cells(const Situation<d>& at) {
  if (at.options.expected_grid && at.options.method != Method::cells)
    return std::nullopt;  // `outer_product` is the same there
  return propose<d>(at, Method::cells);
}

template <int d>
std::optional<Proposal<d>> propose_outer_product(const Situation<d>& at) {
  if (!at.options.expected_grid && at.options.method != Method::outer_product) return std::nullopt;
  return propose<d>(at, Method::outer_product);
}

/// `chosen`: Cells or OuterProduct.
void print_cells(std::ostream& out, const auto& chosen) {
  out << ", cells of side " << chosen.side << ", " << chosen.within_reach << " within reach, " << chosen.occupied
      << " occupied";
}

std::vector<Parameter> list_cells(const auto& chosen) {
  return {{"side", chosen.side},
          {"within_reach", std::int64_t{chosen.within_reach}},
          {"occupied", static_cast<std::int64_t>(chosen.occupied)}};
}

}  // namespace

MethodEntry cells_method() {
  return {
      .method = Method::cells,
      .name = "cells",
      .meaning = "pairs within reach, found by cells; for sharp Gaussians",
      .search_seconds = cost::cells_search,
      .propose = {propose_cells<1>, propose_cells<2>, propose_cells<3>, propose_cells<4>},
      .print = [](std::ostream& out, const Choice& choice) { print_cells(out, std::get<Cells>(choice.parameters)); },
      .parameters = [](const Choice& choice) { return list_cells(std::get<Cells>(choice.parameters)); }};
}

MethodEntry outer_product_method() {
  return {.method = Method::outer_product,
          .name = "outer",
          .meaning = "outer products of a row of values an axis; for few sources on a tensor grid",
          .search_seconds = cost::outer_product_search,
          .propose = {propose_outer_product<1>, propose_outer_product<2>, propose_outer_product<3>,
                      propose_outer_product<4>},
          .print = [](std::ostream& out,
                      const Choice& choice) { print_cells(out, std::get<OuterProduct>(choice.parameters)); },
          .parameters = [](const Choice& choice) { return list_cells(std::get<OuterProduct>(choice.parameters)); }};
}

}  // namespace fgtd::detail
