// Tensor grids of `spread`: one Gaussian is filtered onto the grid itself. Several are filtered onto the lattice around
// the grid, where they add up, and phi takes their sum from there to the grid.
#include <algorithm>
#include <optional>

#include "fgtd/spread/sum.hpp"

namespace fgtd::detail {
namespace {

/// The part of the lattice that the grid looks at and a brick of sources reaches; none if that is empty.
template <int d>
std::optional<Brick<d>> brick_of_grid(const LatticeFrame<d>& frame, const Brick<d>& source, std::int64_t reach,
                                      const FilterTargets<d>& grid) {
  std::array<std::int64_t, d> low, high;
  for (std::size_t l = 0; l < d; ++l) {
    const std::int64_t first = source.first[l] - reach - frame.width,
                       last = source.first[l] + static_cast<std::int64_t>(source.nodes[l]) + reach;
    const auto node = [&](double y) {  // far nodes are no integers
      constexpr double farthest = 0x1p50;
      return frame.first_node(std::clamp(y, -farthest * frame.spacing, farthest * frame.spacing));
    };
    low[l] = std::max(first, node(grid.coordinate[l].front()));
    high[l] = std::min(last, node(grid.coordinate[l].back()));
    if (low[l] > high[l]) return std::nullopt;
  }
  return brick_around<d>(low, high, frame.width);
}

/// Values as they are.
template <int d>
Request<d> value_alone() {
  Request<d> request;
  request.derivatives.push_back({});
  request.combinations.push_back({{0, 1.0}});
  return request;
}

}  // namespace

template <int d>
void SpreadSum<d>::evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const {
  evaluate(std::vector<Request<d>>{request}, grid, values);
}

template <int d>
void SpreadSum<d>::evaluate(const std::vector<Request<d>>& requests, const TensorGrid& grid, double* values) const {
  const std::size_t outputs = requests[0].combinations.size() * columns_;
  if (grid.size() == 0 || outputs == 0) return;
  FilterTargets<d> targets;
  for (std::size_t l = 0; l < d; ++l)
    for (const double y : grid.axes[l]) targets.coordinate[l].push_back(y - layout_.frame.anchor[l]);
  if (parts_.size() == 1) {
    FilterJob<d> job{*parts_[0].filter, layout_.frame, parts_[0].sigma, requests[0], columns_, {}, {}, threads_};
    for (const auto& brick : layout_.bricks) {
      job.bricks.push_back(&brick);
      job.lattice.push_back(lattice_.data() + columns_ * brick.offset);
    }
    apply_filter<d>(job, targets, grid.axes[0].size(), grid.size(), values);
    return;
  }
  targets.by_window = true;
  in_pieces(outputs * grid.size(), cost::spread_value, threads_,
            [&](std::size_t begin, std::size_t end) { std::fill(values + begin, values + end, 0.0); });
  const Request<d> value = value_alone<d>();
  for (const auto& brick : layout_.bricks) {
    const std::optional<Brick<d>> around = brick_of_grid<d>(layout_.frame, brick, lattice_reach(), targets);
    if (!around) continue;
    const Buffer<double> lattice = filtered(requests, brick, *around);
    apply_filter<d>({*parts_[0].filter,
                     layout_.frame,
                     parts_[0].sigma,
                     value,
                     outputs,
                     {&*around},
                     {lattice.data()},
                     threads_,
                     true},
                    targets, grid.axes[0].size(), grid.size(), values);
  }
}

template <int d>
double SpreadSum<d>::grid_bytes(const Request<d>& request, const TensorGrid& grid) const {
  double largest = 0;
  std::array<double, d> sizes;
  for (std::size_t l = 0; l < d; ++l) sizes[l] = static_cast<double>(grid.axes[l].size());
  for (const SpreadPart& part : parts_) {
    FilterJob<d> job{*part.filter, layout_.frame, part.sigma, request, columns_, {}, {}, threads_};
    for (const auto& brick : layout_.bricks) job.bricks.push_back(&brick);
    largest = std::max(largest, filter_bytes<d>(job, sizes, false));
  }
  return parts_.size() == 1 ? largest : largest + point_bytes(request, 0);  // the lattice around the grid
}

#define FGTD_INSTANTIATE(d)                                                                               \
  template void SpreadSum<d>::evaluate(const Request<d>&, const TensorGrid&, double*) const;              \
  template void SpreadSum<d>::evaluate(const std::vector<Request<d>>&, const TensorGrid&, double*) const; \
  template double SpreadSum<d>::grid_bytes(const Request<d>&, const TensorGrid&) const;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
