// The window of `spread` by prediction of cost: fewer nodes make spreading cheaper and the lattice finer.
#include <algorithm>
#include <cmath>
#include <memory>
#include <ostream>
#include <utility>

#include "fgtd/catalogue.hpp"
#include "fgtd/check.hpp"
#include "fgtd/spread/cost.hpp"
#include "fgtd/spread/sum.hpp"

namespace fgtd::detail {
namespace {

constexpr double finest_tolerance = 3e-14;  // below it rounding takes what the window leaves
constexpr double glance_error = 4;          // factor by which a prediction without a look at the points may be too high
constexpr double narrow_windows_from = 8e-7;  // tolerances below which a window of one node less serves

/// Nodes of the lattice along each axis.
template <int d>
using Extent = std::array<double, d>;

/// Predicted seconds of the filter from one brick, whose corner is `corner` (from the origin).
template <int d>
double filter_seconds(const Situation<d>& at, const Extent<d>& nodes, const Extent<d>& corner, double spacing,
                      double reach, double derivatives) {
  double seconds = 0, done = 1, inner = 1;
  for (std::size_t l = 0; l < d; ++l) inner *= nodes[l];
  for (std::size_t l = d; l-- > 0;) {
    double targets = nodes[l] + 2 * reach, group = l == 0 ? 24 : 8;
    if (at.options.expected_grid) {
      const auto& axis = at.options.expected_grid->axes[l];
      const double low = corner[l] - reach * spacing, high = corner[l] + (nodes[l] + reach) * spacing;
      targets = static_cast<double>(std::upper_bound(axis.begin(), axis.end(), high) -
                                    std::lower_bound(axis.begin(), axis.end(), low));
      if (targets > 1) group *= std::min(1.0, (nodes[l] + 2 * reach) / targets);  // nodes of the lattice it spans
    }
    inner /= nodes[l];
    const double sums = done * targets * inner * std::min(derivatives, l + 1 == d ? 2.0 : derivatives);
    seconds += at.columns * sums * (2 * reach + std::min(group, 2 * reach)) * cost::spread_step;
    seconds += targets * 2 * reach * cost::spread_entry;
    done *= targets;
  }
  return seconds;
}

template <int d>
double spread_seconds(const Situation<d>& at, const std::vector<Extent<d>>& bricks,
                      const std::vector<Extent<d>>& corners, int width, double spacing, double reach) {
  const double derivatives = at.options.derivative_order > 0 ? 2 : 1;
  const double vectors = std::ceil(width / 8.0), rows = std::pow(width, d - 1);
  const double place = d * (width + 2) * vectors * cost::spread_place;
  double seconds = at.sources * (cost::spread_sort + place + at.columns * rows * vectors * cost::spread_row);
  for (std::size_t b = 0; b < bricks.size(); ++b) {
    double nodes = 1;
    for (const double n : bricks[b]) nodes *= n;
    seconds += nodes * at.columns * cost::spread_node +
               filter_seconds<d>(at, bricks[b], corners[b], spacing, reach, derivatives);
  }
  if (at.options.expected_grid) return seconds + at.targets * at.columns * derivatives * cost::spread_value;
  return seconds +
         at.targets * (cost::spread_sort + place + derivatives * at.columns * rows * vectors * cost::spread_gather);
}

/// Windows that may serve, with their predicted seconds, the fastest first: on a lattice that is dense, but not denser
/// than single sources would need. None if the lattice has no finite size.
template <int d>
std::vector<std::pair<double, int>> windows_by_cost(const Situation<d>& at) {
  const double tolerance = at.options.tolerance, root = std::sqrt(at.sigma);
  const int order = at.options.derivative_order;
  const int wide = std::clamp(static_cast<int>(std::ceil(1.9 - std::log10(tolerance))), 4, largest_window);
  std::vector<std::pair<double, int>> windows;
  for (int width = tolerance <= narrow_windows_from ? wide - 1 : wide; width <= wide; ++width) {
    const double spacing = expected_spacing(width, order, tolerance);
    const double reach = 1.2 * std::sqrt(std::log(1 / tolerance) + order) / spacing;
    Extent<d> extent;
    double nodes = 1;
    for (std::size_t l = 0; l < d; ++l) {
      extent[l] = at.extent[l] * root / spacing + width + 2;
      nodes *= extent[l];
    }
    const double shrink = std::min(1.0, std::pow(at.sources * std::pow(width + 2, d) / nodes, 1.0 / d));
    for (double& n : extent) n = std::max(n * shrink, width + 2.0);
    if (!std::isfinite(nodes)) return {};
    windows.emplace_back(spread_seconds<d>(at, {extent}, {at.low}, width, spacing / root, reach), width);
  }
  std::sort(windows.begin(), windows.end());
  return windows;
}

template <int d>
std::optional<Proposal<d>> propose_spread(const Situation<d>& at) {
  const double tolerance = at.options.tolerance;
  const int order = at.options.derivative_order;
  if (tolerance < finest_tolerance) return std::nullopt;
  const bool asked = at.options.method == Method::spread;
  const double root = std::sqrt(at.sigma);

  const std::vector<std::pair<double, int>> windows = windows_by_cost<d>(at);
  if (windows.empty() || windows[0].first > glance_error * at.to_beat) return std::nullopt;

  std::shared_ptr<const SpreadFilter> filter;
  for (const auto& [seconds, width] : windows)
    if (!filter) filter = find_filter(d, width, order, tolerance);
  if (!filter) return std::nullopt;
  const double spacing = filter->spacing() / root;
  auto layout =
      lay_out<d>(at.position, static_cast<std::size_t>(at.sources), at.low, at.extent, spacing, filter->width());
  if (!layout) return std::nullopt;

  Proposal<d> proposal;
  proposal.plan_bytes = spread_plan_bytes<d>(at, *layout);
  if (proposal.plan_bytes > static_cast<double>(at.options.memory_limit)) {
    if (asked) check_memory("the plan with Method::spread", proposal.plan_bytes, at.options.memory_limit);
    return std::nullopt;
  }
  std::vector<Extent<d>> bricks, corners;
  for (const auto& brick : layout->bricks) {
    bricks.emplace_back();
    corners.emplace_back();
    for (std::size_t l = 0; l < d; ++l) {
      bricks.back()[l] = static_cast<double>(brick.nodes[l]);
      corners.back()[l] = layout->frame.anchor[l] + static_cast<double>(brick.first[l]) * spacing;
    }
  }
  Choice& choice = proposal.choice;
  choice.method = Method::spread;
  choice.bound = std::max(filter->grid_error(d), filter->point_error(d));
  choice.seconds =
      spread_seconds<d>(at, bricks, corners, filter->width(), spacing, filter->reach() / filter->spacing());
  choice.parameters = Spread{.spacing = spacing, .window = filter->width()};
  proposal.make = [filter, sigma = at.sigma, threads = at.options.threads,
                   shared = std::make_shared<SpreadLayout<d>>(std::move(*layout))](Buffer<double> position) {
    return std::make_unique<SpreadSum<d>>(std::vector<SpreadPart>{{sigma, filter}}, std::move(*shared),
                                          std::move(position), threads);
  };
  return proposal;
}

void print_spread(std::ostream& out, const Choice& choice) {
  const Spread& chosen = std::get<Spread>(choice.parameters);
  out << ", lattice spacing " << chosen.spacing << ", window of " << chosen.window << " nodes, " << chosen.bricks
      << (chosen.bricks == 1 ? " brick" : " bricks");
}

std::vector<Parameter> list_spread(const Choice& choice) {
  const Spread& chosen = std::get<Spread>(choice.parameters);
  return {{"spacing", chosen.spacing},
          {"window", std::int64_t{chosen.window}},
          {"bricks", static_cast<std::int64_t>(chosen.bricks)}};
}

}  // namespace

template <int d>
double spread_plan_bytes(const Situation<d>& at, const SpreadLayout<d>& layout) {
  const double tiles = static_cast<double>(layout.bricks.back().first_tile + layout.bricks.back().tile_count());
  return at.sources * (8.0 * (2 * d + at.columns) + 12) + (24 + 12.0 * cells_in_tile<d>()) * tiles +
         8 * at.columns * static_cast<double>(layout.nodes());
}

template double spread_plan_bytes<1>(const Situation<1>&, const SpreadLayout<1>&);
template double spread_plan_bytes<2>(const Situation<2>&, const SpreadLayout<2>&);
template double spread_plan_bytes<3>(const Situation<3>&, const SpreadLayout<3>&);
template double spread_plan_bytes<4>(const Situation<4>&, const SpreadLayout<4>&);

MethodEntry spread_method() {
  return {.method = Method::spread,
          .name = "spread",
          .meaning = "a window spreads the sources to a lattice, where filters act axis by axis; for dense clouds",
          .search_seconds = cost::spread_search,
          .propose = {propose_spread<1>, propose_spread<2>, propose_spread<3>, propose_spread<4>},
          .print = print_spread,
          .parameters = list_spread};
}

}  // namespace fgtd::detail
