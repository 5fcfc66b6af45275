// Computes the matrices of matrices.hpp from tables of Hermite functions.
#include "fgtd/chebyshev/matrices.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/kernels/kernels.hpp"
#include "fgtd/request.hpp"

namespace fgtd::detail {
namespace {

constexpr double grid_group_sides = 2;  // the nodes of a group lie within so many boxes

/// numbers[a][i] = h~_a(t_i) for all orders a; the numbers are padded as products want it.
void tabulate(AxisMatrices& matrices, std::vector<double> t, int highest) {
  matrices.order_step = (t.size() + chain_padding + row_padding - 1) / row_padding * row_padding;
  t.resize(matrices.order_step, 0.0);
  matrices.numbers.assign(matrices.order_step * static_cast<std::size_t>(highest + 1), 0.0);
  const RecurrenceTable recurrence(highest + 1);
  kernels().table({.count = matrices.order_step,
                   .orders = highest + 1,
                   .t = t.data(),
                   .rows = matrices.numbers.data(),
                   .stride = matrices.order_step,
                   .recurrence = recurrence.view()});
}

}  // namespace

AxisMatrices box_matrices(const std::vector<double>& node, double scaled_side, std::int64_t neighbours, int highest,
                          bool transposed) {
  AxisMatrices matrices;
  matrices.nodes = node.size();
  matrices.transposed = transposed;
  matrices.neighbours = neighbours;
  std::vector<double> t;
  for (std::int64_t source = -neighbours; source <= neighbours; ++source)
    for (std::size_t i = 0; i < node.size(); ++i)
      for (std::size_t k = 0; k < node.size(); ++k) {
        const double apart = transposed ? node[k] - node[i] : node[i] - node[k];  // target minus source
        t.push_back(scaled_side * (0.5 * apart - static_cast<double>(source)));
      }
  tabulate(matrices, std::move(t), highest);
  return matrices;
}

std::vector<AxisMatrices::Group> grid_groups(const std::vector<double>& nodes, double origin, double side,
                                             std::int64_t boxes, double reach, std::size_t p) {
  std::vector<AxisMatrices::Group> groups;
  std::size_t numbers = 0;
  for (std::size_t i = 0; i < nodes.size();) {
    std::size_t end = i + 1;
    while (end < nodes.size() && end - i < grid_group && nodes[end] - nodes[i] <= grid_group_sides * side) ++end;
    const double last = static_cast<double>(boxes - 1);
    const double low = std::clamp(std::floor((nodes[i] - origin - reach) / side - 1), 0.0, last);
    const double high = std::clamp(std::floor((nodes[end - 1] - origin + reach) / side + 1), 0.0, last);
    const AxisMatrices::Group group{i, end - i, static_cast<std::int64_t>(low), static_cast<std::int64_t>(high),
                                    numbers};
    groups.push_back(group);
    numbers += static_cast<std::size_t>(group.high - group.low + 1) * group.rows * p;
    i = end;
  }
  return groups;
}

double group_numbers(const std::vector<AxisMatrices::Group>& groups, std::size_t p) {
  if (groups.empty()) return 0;
  const AxisMatrices::Group& last = groups.back();
  return static_cast<double>(last.matrix) +
         static_cast<double>(last.high - last.low + 1) * static_cast<double>(last.rows) * static_cast<double>(p);
}

AxisMatrices grid_matrices(const std::vector<double>& nodes, const std::vector<double>& node, double origin,
                           double side, std::int64_t boxes, double root_sigma, double reach, int highest,
                           bool transposed) {
  AxisMatrices matrices;
  const std::size_t p = node.size();
  matrices.nodes = p;
  matrices.transposed = transposed;
  matrices.group = grid_groups(nodes, origin, side, boxes, reach / root_sigma, p);
  std::vector<double> t;
  t.reserve(static_cast<std::size_t>(group_numbers(matrices.group, p)) + 2 * row_padding);
  for (const auto& group : matrices.group)
    for (std::int64_t source = group.low; source <= group.high; ++source) {
      const double corner = origin + static_cast<double>(source) * side;
      // A node out of the box's reach gets 0, whatever its group does: an argument of 1e3 gives 0.
      const auto argument = [&](std::size_t row, std::size_t k) {
        const double above = nodes[group.first_row + row] - corner;
        const double gap = std::max(-above, above - side);
        return gap * root_sigma > reach ? 1e3 : root_sigma * (above - 0.5 * side * (1 + node[k]));
      };
      if (transposed) {
        for (std::size_t k = 0; k < p; ++k)
          for (std::size_t row = 0; row < group.rows; ++row) t.push_back(argument(row, k));
      } else {
        for (std::size_t row = 0; row < group.rows; ++row)
          for (std::size_t k = 0; k < p; ++k) t.push_back(argument(row, k));
      }
    }
  tabulate(matrices, std::move(t), highest);
  return matrices;
}

}  // namespace fgtd::detail
