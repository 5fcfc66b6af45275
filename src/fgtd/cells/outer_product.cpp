// Tensor grids: the Gaussians of a group of neighbouring sources, added to the window of grid nodes within reach by the
// kernel `outer_product`; see fgtd/cells/sum.hpp.
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel.hpp"
#include "fgtd/cells/cost.hpp"
#include "fgtd/cells/job.hpp"
#include "fgtd/cells/sum.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t slabs_a_thread = 4;
constexpr double window_slack = 1.001;    // coordinates may be rounded by so much of a reach, see smallest_side()
constexpr std::size_t widest_vector = 8;  // windows are widened to whole vectors where the axis has the nodes

/// The request as the kernel reads it: the parts of each combination in bundles of equal alpha_0.
template <int d>
struct Bundles {
  std::vector<std::size_t> first_bundle{0}, first_part{0};
  std::vector<int> bundle_order, order;
  std::vector<double> factor;
  std::array<int, max_dimension> highest{};

  explicit Bundles(const Request<d>& request) {
    std::copy_n(request.highest.begin(), d, highest.begin());
    for (const auto& combination : request.combinations) {
      for (int n = 0; n <= highest[0]; ++n) {
        for (const auto& part : combination) {
          const Derivative<d>& alpha = request.derivatives[part.derivative];
          if (alpha[0] != n) continue;
          for (std::size_t l = 0; l < max_dimension; ++l) order.push_back(l < d ? alpha[l] : 0);
          factor.push_back(part.factor);
        }
        if (factor.size() == first_part.back()) continue;
        bundle_order.push_back(n);
        first_part.push_back(factor.size());
      }
      first_bundle.push_back(bundle_order.size());
    }
  }
};

/// Nodes [begin, end) of an axis.
struct Window {
  std::size_t begin, end;
};

/// The nodes of an axis in [low, high].
Window window_of(const std::vector<double>& nodes, double low, double high) {
  const auto begin = std::lower_bound(nodes.begin(), nodes.end(), low);
  const auto end = std::upper_bound(begin, nodes.end(), high);
  return {static_cast<std::size_t>(begin - nodes.begin()), static_cast<std::size_t>(end - nodes.begin())};
}

/// Neighbouring sources that are summed together, and where they count.
template <int d>
struct Group {
  std::size_t first, count;
  std::array<double, d> low, high;
  std::array<Window, d> window;
};

/// Groups in the order of the cells. Cells whose sources reach no node have none.
template <int d>
std::vector<Group<d>> make_groups(const CellLattice<d>& cells, const std::vector<double>& position, std::size_t stride,
                                  double reach, const TensorGrid& grid) {
  std::vector<Group<d>> groups;
  groups.reserve(cells.index.size());
  for (std::size_t cell = 0; cell < cells.index.size(); ++cell)
    for (std::size_t first = cells.first[cell]; first < cells.first[cell + 1]; first += outer_product_depth) {
      Group<d> group;
      group.first = first;
      group.count = std::min(outer_product_depth, cells.first[cell + 1] - first);
      bool empty = false;
      for (std::size_t l = 0; l < d && !empty; ++l) {
        const double* x = position.data() + l * stride + first;
        group.low[l] = group.high[l] = x[0];
        for (std::size_t p = 1; p < group.count; ++p) {
          group.low[l] = std::min(group.low[l], x[p]);
          group.high[l] = std::max(group.high[l], x[p]);
        }
        group.window[l] = window_of(grid.axes[l], group.low[l] - reach, group.high[l] + reach);
        empty = group.window[l].begin == group.window[l].end;
      }
      if (empty) continue;
      Window& row = group.window[0];
      const std::size_t nodes = grid.axes[0].size();
      const std::size_t width = (row.end - row.begin + widest_vector - 1) / widest_vector * widest_vector;
      if (width <= nodes) row = {std::min(row.begin, nodes - width), std::min(row.begin, nodes - width) + width};
      groups.push_back(group);
    }
  return groups;
}

/// Cuts the last axis into slabs of about the same work: nodes cuts[i] .. cuts[i+1]. What is added to a node, and in
/// which order, does not depend on the cuts.
template <int d>
std::vector<std::size_t> cut_slabs(const std::vector<Group<d>>& groups, std::size_t nodes, std::size_t slabs) {
  std::vector<std::size_t> cuts{0};
  if (slabs > 1) {
    std::vector<double> work(nodes + 1, 0.0);  // changes from node to node, then of each node
    for (const auto& group : groups) {
      double part = static_cast<double>(group.count);
      for (std::size_t l = 0; l + 1 < d; ++l) part *= static_cast<double>(group.window[l].end - group.window[l].begin);
      work[group.window[d - 1].begin] += part;
      work[group.window[d - 1].end] -= part;
    }
    double total = 0, now = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      now += work[i];
      work[i] = now + 1;
      total += work[i];
    }
    double sum = 0;
    for (std::size_t i = 0; i < nodes; ++i) {
      sum += work[i];
      if (sum * static_cast<double>(slabs) >= total * static_cast<double>(cuts.size()) && i + 1 < nodes)
        cuts.push_back(i + 1);
    }
  }
  cuts.push_back(nodes);
  return cuts;
}

/// What a sum of these groups takes.
template <int d>
struct Work {
  double pairs = 0;                      // of a source and a node
  std::array<std::size_t, d> longest{};  // nodes that the kernel sees at once, of each axis

  explicit Work(const std::vector<Group<d>>& groups) {
    for (const Group<d>& group : groups) {
      double of_group = static_cast<double>(group.count);
      for (std::size_t l = 0; l < d; ++l) {
        const std::size_t nodes = group.window[l].end - group.window[l].begin;
        longest[l] = std::min(outer_product_nodes, std::max(longest[l], nodes));
        of_group *= static_cast<double>(nodes);
      }
      pairs += of_group;
    }
  }
};

/// Adds the sources of `job` at the nodes of a window, in blocks of at most outer_product_nodes nodes an axis, so that
/// the tables stay small.
template <int d>
void sum_window(OuterProductJob& job, const std::array<Window, d>& window, const TensorGrid& grid, double* values) {
  std::array<std::size_t, d> begin;
  for (std::size_t l = 0; l < d; ++l) begin[l] = window[l].begin;
  while (true) {
    job.out = values;
    for (std::size_t l = 0; l < d; ++l) {
      job.node[l] = grid.axes[l].data() + begin[l];
      job.nodes[l] = std::min(outer_product_nodes, window[l].end - begin[l]);
      job.out += begin[l] * job.step[l];
    }
    kernels().outer_product(job);
    std::size_t l = 0;
    for (; l < d; ++l) {
      begin[l] += outer_product_nodes;
      if (begin[l] < window[l].end) break;
      begin[l] = window[l].begin;
    }
    if (l == d) return;
  }
}

}  // namespace

template <int d>
void CellsSum<d>::evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const {
  const std::size_t outputs = request.combinations.size() * columns_, total = grid.size();
  if (outputs == 0 || total == 0) return;
  const Bundles<d> bundles(request);
  const RecurrenceTable recurrence(max_derivative_order + 1);
  const double reach = window_slack * plan_.reach / std::sqrt(sigma_);
  const std::vector<Group<d>> groups = make_groups<d>(cells_, position_, count_, reach, grid);
  const std::size_t threads = static_cast<std::size_t>(gaussdrift::base::resolve_threads(threads_));
  const std::vector<std::size_t> cuts =
      cut_slabs<d>(groups, grid.axes[d - 1].size(), threads > 1 ? slabs_a_thread * threads : 1);
  const Work<d> work(groups);
  const std::size_t scratch_size = outer_product_scratch(d, bundles.highest.data(), work.longest.data());
  std::array<std::size_t, d> step;
  for (std::size_t l = 0; l < d; ++l) step[l] = l == 0 ? 1 : step[l - 1] * grid.axes[l - 1].size();

  const double seconds = static_cast<double>(outputs) * (work.pairs * cost::outer_product_step +
                                                         static_cast<double>(total) * cost::outer_product_value);
  gaussdrift::base::parallel_for({cuts.size() - 1, seconds}, threads_, [&](std::size_t slab) {
    for (std::size_t output = 0; output < outputs; ++output)
      std::fill(values + output * total + cuts[slab] * step[d - 1],
                values + output * total + cuts[slab + 1] * step[d - 1], 0.0);
    const auto scratch = std::make_unique_for_overwrite<double[]>(scratch_size);
    OuterProductJob job{.dimension = d,
                        .degree = plan_.row_degree,
                        .root_sigma = std::sqrt(sigma_),
                        .reach = reach,
                        .sources = 0,
                        .position = nullptr,
                        .weights = nullptr,
                        .stride = count_,
                        .columns = columns_,
                        .low = nullptr,
                        .high = nullptr,
                        .node = {},
                        .nodes = {1, 1, 1, 1},
                        .step = {},
                        .highest = bundles.highest.data(),
                        .combinations = request.combinations.size(),
                        .first_bundle = bundles.first_bundle.data(),
                        .bundle_order = bundles.bundle_order.data(),
                        .first_part = bundles.first_part.data(),
                        .order = bundles.order.data(),
                        .factor = bundles.factor.data(),
                        .recurrence = recurrence.view(),
                        .scratch = scratch.get(),
                        .out = nullptr,
                        .output_stride = total};
    std::copy_n(step.begin(), d, job.step);

    for (const Group<d>& group : groups) {
      std::array<Window, d> window = group.window;
      window[d - 1].begin = std::max(window[d - 1].begin, cuts[slab]);
      window[d - 1].end = std::min(window[d - 1].end, cuts[slab + 1]);
      if (window[d - 1].begin >= window[d - 1].end) continue;
      job.sources = group.count;
      job.position = position_.data() + group.first;
      job.weights = weights_.data() + group.first;
      job.low = group.low.data();
      job.high = group.high.data();
      sum_window<d>(job, window, grid, values);
    }
  });
}

template <int d>
double CellsSum<d>::grid_bytes(const Request<d>& request, const TensorGrid& grid) const {
  const double threads = gaussdrift::base::resolve_threads(threads_);
  std::array<std::size_t, d> longest;
  for (std::size_t l = 0; l < d; ++l) longest[l] = std::min(outer_product_nodes, grid.axes[l].size());
  const double groups = static_cast<double>(cells_.index.size() + count_ / outer_product_depth);
  return 2 * groups * sizeof(Group<d>) + 8.0 * 2 * static_cast<double>(grid.axes[d - 1].size()) +
         threads * 8 * static_cast<double>(outer_product_scratch(d, request.highest.data(), longest.data()));
}

#define FGTD_INSTANTIATE(d)                                                                 \
  template void CellsSum<d>::evaluate(const Request<d>&, const TensorGrid&, double*) const; \
  template double CellsSum<d>::grid_bytes(const Request<d>&, const TensorGrid&) const;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
