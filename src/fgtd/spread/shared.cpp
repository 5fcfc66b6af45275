#include "fgtd/spread/shared.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "fgtd/spread/cost.hpp"

namespace fgtd::detail {
namespace {

constexpr double spare_digits = 1.9;          // nodes of a window more than digits: see propose.cpp
constexpr double narrow_windows_from = 8e-7;  // tolerances below which a window of one node less serves
constexpr double finest_tolerance = 3e-14;
constexpr double most_nodes = 2e8;
constexpr double finest_spacing = 2e-3;  // of the width of a Gaussian: filters are tables of so many numbers
// Seconds of a filter for each node that it reaches, and of an entry of its matrices.
constexpr double filter_node = 1e-6, matrix_entry = 3e-9;

struct Lattice {
  SpreadWindow window;
  double spacing = 0;
};

double strictest(const std::vector<Gaussian>& gaussians) {
  double least = 1;
  for (const Gaussian& of : gaussians) least = std::min(least, of.tolerance);
  return least;
}

/// As fine as each of the Gaussians needs.
Lattice lattice_for(const std::vector<Gaussian>& gaussians, int width, int order) {
  Lattice lattice{SpreadWindow::of(width, strictest(gaussians)), std::numeric_limits<double>::infinity()};
  for (const Gaussian& of : gaussians)
    lattice.spacing = std::min(lattice.spacing, expected_spacing(width, order, of.tolerance) / std::sqrt(of.sigma));
  return lattice;
}

/// Multiplications of matrices along one axis after the other, the last first, for targets that lie like the sources.
template <int d>
double passes(const std::array<double, d>& nodes, const std::array<double, d>& targets, double band,
              double derivatives) {
  double inner = 1, done = 1, steps = 0;
  for (const double n : nodes) inner *= n;
  for (std::size_t l = d; l-- > 0;) {
    inner /= nodes[l];
    const double group = l == 0 ? 24 : 8;
    steps += done * targets[l] * inner * derivatives * std::min(nodes[l], band + std::min(group, band));
    done *= targets[l];
  }
  return steps * cost::spread_step;
}

template <int d>
double seconds_on(const Situation<d>& at, const std::vector<Gaussian>& gaussians, const Lattice& lattice) {
  const double width = lattice.window.width, derivatives = at.options.derivative_order > 0 ? 2 : 1;
  std::array<double, d> nodes;
  double all = 1;
  for (std::size_t l = 0; l < d; ++l) all *= nodes[l] = at.extent[l] / lattice.spacing + width + 2;
  if (!(all < most_nodes)) return std::numeric_limits<double>::infinity();
  const double shrink = std::min(1.0, std::pow(at.sources * std::pow(width + 2, d) / all, 1.0 / d));
  all = 1;
  for (double& n : nodes) all *= n = std::max(n * shrink, width + 2);

  const double vectors = std::ceil(width / 8), rows = std::pow(width, d - 1);
  const double place = cost::spread_sort + d * (width + 2) * vectors * cost::spread_place;
  double seconds = at.sources * (place + at.columns * rows * vectors * cost::spread_row) +
                   all * at.columns * (1 + derivatives) * cost::spread_node;
  for (const Gaussian& of : gaussians) {
    const double reach = 1.2 * std::sqrt(std::log(1 / of.tolerance) + at.options.derivative_order) /
                         (lattice.spacing * std::sqrt(of.sigma));
    if (reach > 8 / finest_spacing) return std::numeric_limits<double>::infinity();
    seconds += filter_node * reach * (1 + at.options.derivative_order) +
               at.columns * (passes<d>(nodes, nodes, 2 * reach, derivatives) + all * derivatives * cost::spread_value);
    for (const double n : nodes) seconds += matrix_entry * derivatives * n * std::min(n, 2 * reach);
  }
  if (!at.options.expected_grid)
    return seconds + at.targets * (place + derivatives * at.columns * rows * vectors * cost::spread_gather);
  std::array<double, d> axes;
  for (std::size_t l = 0; l < d; ++l) axes[l] = static_cast<double>(at.options.expected_grid->axes[l].size());
  return seconds + at.columns * derivatives * (passes<d>(nodes, axes, width, 1) + at.targets * cost::spread_value);
}

/// Windows that may serve, the faster first.
template <int d>
std::vector<std::pair<double, int>> windows_by_cost(const Situation<d>& at, const std::vector<Gaussian>& gaussians) {
  const double tolerance = strictest(gaussians);
  if (tolerance < finest_tolerance) return {};
  const int wide = std::clamp(static_cast<int>(std::ceil(spare_digits - std::log10(tolerance))), 4, largest_window);
  std::vector<std::pair<double, int>> windows;
  for (int width = tolerance <= narrow_windows_from ? wide - 1 : wide; width <= wide; ++width)
    windows.emplace_back(seconds_on<d>(at, gaussians, lattice_for(gaussians, width, at.options.derivative_order)),
                         width);
  std::sort(windows.begin(), windows.end());
  return windows;
}

/// The filters on the widest lattice on which all keep their tolerances; none if there is none.
template <int d>
std::vector<SpreadPart> find_parts(const std::vector<Gaussian>& gaussians, int width, int order, Lattice& lattice) {
  lattice = lattice_for(gaussians, width, order);
  const double widest = lattice.spacing;
  for (; lattice.spacing > 0.5 * widest; lattice.spacing *= 0.96) {
    std::vector<SpreadPart> parts;
    for (auto of = gaussians.rbegin(); of != gaussians.rend(); ++of) {  // those that need the finest lattice first
      auto filter = lattice_filter(lattice.window, lattice.spacing * std::sqrt(of->sigma), order, of->tolerance);
      if (!(filter->point_error(d) <= of->tolerance)) break;
      parts.insert(parts.begin(), {of->sigma, std::move(filter)});
    }
    if (parts.size() == gaussians.size()) return parts;
  }
  return {};
}

}  // namespace

template <int d>
double shared_seconds(const Situation<d>& at, const std::vector<Gaussian>& gaussians) {
  const auto windows = windows_by_cost<d>(at, gaussians);
  return windows.empty() ? std::numeric_limits<double>::infinity() : windows[0].first;
}

template <int d>
std::optional<SharedProposal<d>> propose_shared(const Situation<d>& at, const std::vector<Gaussian>& gaussians) {
  SharedProposal<d> proposal;
  Lattice lattice;
  for (const auto& [seconds, width] : windows_by_cost<d>(at, gaussians))
    if (proposal.parts.empty() && std::isfinite(seconds))
      proposal.parts = find_parts<d>(gaussians, width, at.options.derivative_order, lattice);
  if (proposal.parts.empty()) return std::nullopt;
  auto layout = lay_out<d>(at.position, static_cast<std::size_t>(at.sources), at.low, at.extent, lattice.spacing,
                           lattice.window.width);
  if (!layout) return std::nullopt;
  proposal.layout = std::move(*layout);
  proposal.plan_bytes = spread_plan_bytes<d>(at, proposal.layout);
  const double seconds = seconds_on<d>(at, gaussians, lattice) / static_cast<double>(gaussians.size());
  for (const SpreadPart& part : proposal.parts) {
    Choice& choice = proposal.choices.emplace_back();
    choice.method = Method::spread;
    choice.bound = part.filter->point_error(d);
    choice.seconds = seconds;
    choice.sources = static_cast<std::size_t>(at.sources);
    choice.targets = static_cast<std::size_t>(at.targets);
    choice.parameters =
        Spread{.spacing = lattice.spacing, .window = lattice.window.width, .bricks = proposal.layout.bricks.size()};
  }
  for (std::size_t k = 0; k < gaussians.size(); ++k) proposal.choices[k].tolerance = gaussians[k].tolerance;
  return proposal;
}

#define FGTD_INSTANTIATE(d)                                                             \
  template double shared_seconds<d>(const Situation<d>&, const std::vector<Gaussian>&); \
  template std::optional<SharedProposal<d>> propose_shared<d>(const Situation<d>&, const std::vector<Gaussian>&);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
