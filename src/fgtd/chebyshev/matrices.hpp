// The Gaussian and its derivatives on one axis, as matrices between nodes of boxes and targets.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace fgtd::detail {

constexpr std::size_t grid_group = 16;  // nodes of a grid that are computed together

/// Matrices of the Gaussian and its derivatives on one axis, between the nodes of source boxes and groups of targets. A
/// group is the nodes of a box, or neighbouring nodes of a grid. A matrix is rows x P. For the first axis it stands on
/// the right and is P x rows.
struct AxisMatrices {
  struct Group {
    std::size_t first_row, rows;
    std::int64_t low, high;  // boxes in reach
    std::size_t matrix;      // of box `low` and derivative 0
  };
  std::vector<Group> group;     // of a grid
  std::size_t nodes = 0;        // P
  bool transposed = false;      //
  std::int64_t neighbours = 0;  // boxes: matrices depend on the difference of indices only
  std::vector<double> numbers;
  std::size_t order_step = 0;  // from one derivative to the next

  Group box(std::int64_t index) const { return {0, nodes, index - neighbours, index + neighbours, 0}; }
  const double* matrix(const Group& of, std::int64_t source, int order) const {
    // group.low sees the source at the greatest difference of indices, which comes first
    return numbers.data() + static_cast<std::size_t>(order) * order_step + of.matrix +
           static_cast<std::size_t>(source - of.low) * of.rows * nodes;
  }
};

/// Between boxes of nodes `node` in [-1, 1], for boxes up to `neighbours` apart and derivatives up to `highest`.
AxisMatrices box_matrices(const std::vector<double>& node, double scaled_side, std::int64_t neighbours, int highest,
                          bool transposed);

/// Groups of grid nodes, each with those of the `boxes` boxes that are in its reach.
std::vector<AxisMatrices::Group> grid_groups(const std::vector<double>& nodes, double origin, double side,
                                             std::int64_t boxes, double reach, std::size_t p);
/// Numbers that the matrices of those groups take for one derivative.
double group_numbers(const std::vector<AxisMatrices::Group>& groups, std::size_t p);

/// From boxes to the nodes of an axis of a grid; `reach` is in units of 1/root_sigma.
AxisMatrices grid_matrices(const std::vector<double>& nodes, const std::vector<double>& node, double origin,
                           double side, std::int64_t boxes, double root_sigma, double reach, int highest,
                           bool transposed);

}  // namespace fgtd::detail
