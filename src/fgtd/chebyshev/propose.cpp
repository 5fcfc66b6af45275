// Chooses the number of nodes and the sides of the boxes of `chebyshev`: the cheapest by prediction of all that keep
// the tolerance.
#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "fgtd/bounds.hpp"
#include "fgtd/catalogue.hpp"
#include "fgtd/chebyshev/cost.hpp"
#include "fgtd/chebyshev/error.hpp"
#include "fgtd/chebyshev/sum.hpp"
#include "fgtd/check.hpp"

namespace fgtd::detail {
namespace {

constexpr int node_counts[] = {2, 3, 4, 5, 6, 7, 8, 10, 12, 14, 16};
constexpr double most_box_numbers = 1 << 16;   // P^d
constexpr std::size_t points_glanced_at = 64;  // of the sample; then, where a closer look may pay,
constexpr std::size_t points_looked_at = 1024;
constexpr double glance_error = 2;        // factor by which a prediction from a glance may be too high
constexpr double most_neighbours = 2048;  // of which a table is made

/// Occupied boxes of a lattice, estimated from the sample. leading[j] counts the distinct (i_0, ..., i_j) of sources,
/// trailing[j] the distinct (i_j, ..., i_{d-1}) of targets that lie like the sources.
template <int d>
struct Occupied {
  std::array<double, d> leading, trailing;
};

template <int d>
Occupied<d> all_occupied(const BoxLattice<d>& lattice) {
  Occupied<d> found;
  double product = 1;
  for (std::size_t l = 0; l < d; ++l) found.leading[l] = product *= static_cast<double>(lattice.boxes[l]);
  product = 1;
  for (std::size_t l = d; l-- > 0;) found.trailing[l] = product *= static_cast<double>(lattice.boxes[l]);
  return found;
}

/// Everything in one box: a bound from below.
template <int d>
Occupied<d> one_box() {
  Occupied<d> found;
  found.leading.fill(1);
  found.trailing.fill(1);
  return found;
}

template <int d>
Occupied<d> occupied(const Situation<d>& at, const BoxLattice<d>& lattice, std::size_t most_looked_at) {
  Occupied<d> found = all_occupied<d>(lattice);
  if (found.trailing[0] <= 8) return found;  // not worth a look
  const std::size_t looked_at = std::min(at.sample_count, most_looked_at);
  const auto count = [&](bool upwards, std::array<double, d>& into) {
    std::vector<BoxIndex<d>> index(looked_at);  // slowest last
    for (std::size_t i = 0; i < looked_at; ++i)
      for (std::size_t l = 0; l < d; ++l)
        index[i][upwards ? d - 1 - l : l] = static_cast<std::int64_t>(std::floor(
            (at.sample[l * at.sample_count + i * at.sample_count / looked_at] - lattice.origin[l]) / lattice.side[l]));
    const std::vector<std::size_t> order = sorted_places<d>(index);
    std::array<double, d> distinct{};  // of the slowest 1, ..., d axes
    for (std::size_t j = 0; j < order.size(); ++j) {
      std::size_t same = 0;
      if (j > 0)
        while (same < d && index[order[j]][d - 1 - same] == index[order[j - 1]][d - 1 - same]) ++same;
      for (std::size_t l = same; l < d; ++l) distinct[l] += 1;
    }
    for (std::size_t l = 0; l < d; ++l) {
      double& all = upwards ? into[l] : into[d - 1 - l];
      all = std::min(all, extrapolate(distinct[l], static_cast<double>(looked_at), upwards ? at.sources : at.targets));
    }
  };
  count(true, found.leading);
  count(false, found.trailing);
  return found;
}

/// Predicts the seconds of moments and evaluation, part by part.
template <int d>
class Prediction {
 public:
  Prediction(const Situation<d>& at, const ChebyshevPlan<d>& plan, const Occupied<d>& boxes)
      : at_(at), plan_(plan), boxes_(boxes), p_(plan.nodes), numbers_(std::pow(p_, d)) {}

  double seconds() {
    add_moments();
    for (std::size_t l = d; l-- > 0;) add_axis(l);
    if (at_.options.expected_grid) return seconds_ + derivatives_ * at_.targets * at_.columns * cost::grid_value;
    add_targets();
    return seconds_;
  }

 private:
  double sort(double points) const {
    return cost::chebyshev_sort + cost::chebyshev_spread * std::log10(std::max(1.0, boxes_.leading[d - 1] / 100)) +
           (points > cost::chebyshev_sort_cache ? cost::chebyshev_sort_far : 0);
  }

  /// Points sorted a block at a time into few boxes, and what follows for those boxes.
  double by_blocks(double points, double all_boxes) const {
    const double runs = std::min(points, (points / static_cast<double>(block_points(all_boxes)) + 1) * all_boxes);
    return points * (cost::chebyshev_block_sort + d * p_ * cost::chebyshev_block_basis) +
           runs * cost::chebyshev_block_run;
  }
  double by_polynomials(double all_boxes) const {
    return all_boxes * d * numbers_ * (p_ * cost::chebyshev_product + cost::chebyshev_number);
  }

  void add_moments() {
    const double all_boxes = boxes_.leading[d - 1];
    if (plan_.few_boxes) {
      seconds_ = by_blocks(at_.sources, all_boxes) +
                 at_.columns * at_.sources * numbers_ * cost::chebyshev_block_moment +
                 at_.columns * by_polynomials(all_boxes);
      return;
    }
    const double packs = std::ceil(p_ / 8) * 8 / p_, right = d == 1 ? 0 : std::min(p_ * p_, numbers_);
    seconds_ = at_.sources * (sort(at_.sources) + d * p_ * cost::chebyshev_basis + right * cost::chebyshev_step +
                              at_.columns * numbers_ * (d <= 2 ? packs : 1) * cost::chebyshev_step) +
               all_boxes * at_.columns * numbers_ * cost::chebyshev_number;
  }

  /// Boxes of a line along axis l within the window of a row of targets; the axes above are done.
  void add_axis(std::size_t l) {
    const double fetch = boxes_.leading[d - 1] * numbers_ > cost::chebyshev_cache ? cost::chebyshev_fetch : 0;
    const double parents = l == 0 ? 1 : boxes_.leading[l - 1];
    const double window = 2 * std::floor(plan_.reach / (plan_.lattice.side[l] * std::sqrt(at_.sigma))) + 3;
    if (!at_.options.expected_grid)
      seconds_ += window * p_ * p_ * (at_.options.derivative_order + 1) * cost::chebyshev_table;
    const double line = boxes_.leading[l] / parents;
    const double links = std::max(1.0, std::min(line, line * window / static_cast<double>(plan_.lattice.boxes[l])));
    double rows = p_;
    if (at_.options.expected_grid) {
      const auto& axis = at_.options.expected_grid->axes[l];
      const double spacing = axis.size() > 1 ? (axis.back() - axis.front()) / static_cast<double>(axis.size() - 1) : 0;
      rows = std::clamp(spacing > 0 ? std::floor(2 * plan_.lattice.side[l] / spacing) + 1 : 1.0, 1.0,
                        std::min(16.0, std::max(1.0, static_cast<double>(axis.size()))));
      const double groups = std::ceil(static_cast<double>(axis.size()) / rows);
      seconds_ += groups * std::min(window, static_cast<double>(plan_.lattice.boxes[l])) * p_ * rows *
                  (at_.options.derivative_order + 1) * cost::chebyshev_table;
      outputs_ *= groups;
    } else {
      outputs_ = std::min(boxes_.trailing[l], at_.targets);
    }
    const double width = std::pow(p_, static_cast<double>(l));
    // of all parents, those within reach on the axes that are done
    double near = parents;
    for (std::size_t k = 0; k < l && l + 1 < d; ++k) near = std::min(near, boxes_.leading[d - 1]);
    const double filled = std::ceil(width / 8) * 8 / width;  // lanes paid for one used
    const double products = l == 0 ? 1 : above_;
    const double multiplications = l == 0 ? above_ * p_ * std::ceil(rows / 8) * 8 : above_ * rows * p_ * width * filled;
    seconds_ += derivatives_ * at_.columns * outputs_ * cost::chebyshev_contraction;
    seconds_ += derivatives_ * at_.columns * outputs_ * near *
                (links * multiplications * cost::chebyshev_product +
                 products * (cost::chebyshev_call + links * (cost::chebyshev_link + fetch * p_ * width)));
    above_ *= rows;
  }

  /// From the nodes of their boxes to the targets.
  void add_targets() {
    const double target_boxes = std::min(boxes_.trailing[0], at_.targets), a_box = at_.targets / target_boxes;
    if (are_few(target_boxes, numbers_, at_.targets)) {
      seconds_ = seconds_ + by_blocks(at_.targets, target_boxes) +
                 derivatives_ * at_.columns *
                     (at_.targets * numbers_ * cost::chebyshev_block_value + by_polynomials(target_boxes));
      return;
    }
    const double lanes = std::ceil(a_box / 8) * 8 / a_box;
    seconds_ +=
        at_.targets * (sort(at_.targets) + cost::chebyshev_value * derivatives_ * at_.columns +
                       lanes * (d * p_ * cost::chebyshev_basis +
                                derivatives_ * at_.columns * (numbers_ + std::pow(p_, d - 1)) * cost::chebyshev_step));
  }

  const Situation<d>& at_;
  const ChebyshevPlan<d>& plan_;
  const Occupied<d>& boxes_;
  const double p_, numbers_;
  const double derivatives_ = at_.options.derivative_order > 0 ? 2 : 1;
  double above_ = 1, outputs_ = 1;  // rows of the axes that are done, groups of targets there
  double seconds_ = 0;
};

template <int d>
std::optional<Proposal<d>> propose_chebyshev(const Situation<d>& at) {
  if (at.sources >= 0x1p32) return std::nullopt;
  const double tolerance = at.options.tolerance, root = std::sqrt(at.sigma);
  const int order = at.options.derivative_order;
  const double reach = find_reach(1, tolerance, order) * (1 + 1e-12);
  const bool asked = at.options.method == Method::chebyshev;
  std::optional<ChebyshevPlan<d>> best;
  Proposal<d> proposal;
  Choice& choice = proposal.choice;
  choice.seconds = std::numeric_limits<double>::infinity();
  double smallest_memory = std::numeric_limits<double>::infinity();
  for (const int p : node_counts) {
    const double numbers = std::pow(p, d);
    if (numbers > most_box_numbers) continue;
    const double widest = widest_side(d, p, reach, tolerance, order);
    ChebyshevPlan<d> plan{p, reach, {}, false};
    if (!(widest * most_neighbours > 2 * reach) || !fit_lattice<d>(at.low, at.extent, widest / root, plan.lattice))
      continue;
    double all_boxes = 1;
    for (const std::int64_t along_axis : plan.lattice.boxes) all_boxes *= static_cast<double>(along_axis);
    plan.few_boxes = are_few(all_boxes, numbers, at.sources);
    const double to_beat = std::min(at.to_beat, choice.seconds);
    if (!asked && Prediction<d>(at, plan, one_box<d>()).seconds() >= to_beat) continue;
    if (!asked && !plan.few_boxes &&
        Prediction<d>(at, plan, occupied<d>(at, plan.lattice, points_glanced_at)).seconds() >= glance_error * to_beat)
      continue;
    const Occupied<d> boxes =
        plan.few_boxes ? all_occupied<d>(plan.lattice) : occupied<d>(at, plan.lattice, points_looked_at);
    const double memory =
        plan.few_boxes ? 8 * at.sources * d + all_boxes * (8 * at.columns * numbers + 24.0 * d + 8) +
                             block_moments_bytes(d, p, all_boxes, at.sources, at.columns, at.options.threads)
                       : sorting_bytes(d, at.sources) + 8 * at.sources * d +
                             boxes.leading[d - 1] * (8 * at.columns * numbers + 24.0 * d + 8) +
                             8 * at.columns * numbers * 2 * std::ceil(at.sources / std::max(16384.0, 4 * numbers));
    smallest_memory = std::min(smallest_memory, memory);
    if (memory > static_cast<double>(at.options.memory_limit)) continue;
    const double seconds = Prediction<d>(at, plan, boxes).seconds();
    if (seconds >= choice.seconds) continue;
    best = plan;
    proposal.plan_bytes = memory;
    double widest_axis = 0;
    for (const double side : plan.lattice.side) widest_axis = std::max(widest_axis, side);
    choice.method = Method::chebyshev;
    choice.seconds = seconds;
    choice.bound = std::max(interpolation_error(d, widest_axis * root, p, order), dropped_error(1, reach, order));
    choice.parameters = Chebyshev{.box_side = widest_axis,
                                  .nodes = p,
                                  .neighbours = static_cast<int>(std::floor(reach / (widest_axis * root))) + 1};
  }
  if (!best) {
    if (asked && std::isfinite(smallest_memory))
      check_memory("the plan with Method::chebyshev", smallest_memory, at.options.memory_limit);
    return std::nullopt;
  }
  proposal.make = [plan = *best, sigma = at.sigma, threads = at.options.threads](Buffer<double> position) {
    return std::make_unique<ChebyshevSum<d>>(plan, sigma, std::move(position), threads);
  };
  return proposal;
}

void print_chebyshev(std::ostream& out, const Choice& choice) {
  const Chebyshev& chosen = std::get<Chebyshev>(choice.parameters);
  out << ", box side " << chosen.box_side << ", " << chosen.nodes << " nodes an axis, " << chosen.neighbours
      << " neighbours, " << chosen.boxes << " occupied boxes";
}

std::vector<Parameter> list_chebyshev(const Choice& choice) {
  const Chebyshev& chosen = std::get<Chebyshev>(choice.parameters);
  return {{"box_side", chosen.box_side},
          {"nodes", std::int64_t{chosen.nodes}},
          {"neighbours", std::int64_t{chosen.neighbours}},
          {"boxes", static_cast<std::int64_t>(chosen.boxes)}};
}

}  // namespace

MethodEntry chebyshev_method() {
  return {.method = Method::chebyshev,
          .name = "chebyshev",
          .meaning = "interpolation at Chebyshev nodes of boxes; for wide Gaussians",
          .search_seconds = cost::chebyshev_search,
          .propose = {propose_chebyshev<1>, propose_chebyshev<2>, propose_chebyshev<3>, propose_chebyshev<4>},
          .print = print_chebyshev,
          .parameters = list_chebyshev};
}

}  // namespace fgtd::detail
