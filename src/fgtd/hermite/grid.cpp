// Hermite expansions on a tensor grid, one axis after the other as products of matrices. For d = 3, with the tables
// X[b][x] = g_b(sqrt(sigma) (x - c_0)) of a column of boxes, Y and Z likewise,
//   line   T1[b2 b1][x]    = sum_{boxes of a line}  sum_{b0} A[b2 b1 b0] X[b0][x]
//   slab   T2[b2][y x]    += sum_{lines of a slab}  sum_{b1} Y[y][b1] T1[b2 b1][x]
//   grid   S[z][y x]      += sum_{slabs}            sum_{b2} Z[z][b2] T2[b2][y x]
// where every sum over nodes runs over the window of nodes that the boxes reach. Slabs are independent. The grid is
// then updated in pieces of its last axis. Every node adds its slabs in ascending order, so threads change no bit.
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "fgtd/cost.hpp"
#include "fgtd/hermite/hermite.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t batch_numbers = std::size_t{1} << 22;  // slabs kept before the grid is updated (32 MB)

std::size_t padded(std::size_t n) { return (n + row_padding - 1) / row_padding * row_padding; }

/// Nodes begin .. end of one axis.
struct Window {
  std::size_t begin = 0, end = 0;
  std::size_t size() const { return end - begin; }
  void cover(const Window& other) {
    if (other.size() == 0) return;
    *this = size() == 0 ? other : Window{std::min(begin, other.begin), std::max(end, other.end)};
  }
};

/// Windows and tables of the columns of boxes along one axis.
struct AxisTables {
  std::vector<std::int64_t> column;        // distinct box indices
  std::vector<Window> window;              // [columns]
  std::vector<std::vector<double>> table;  // [columns]: first axis [a][b][node], others [a][node][b]
};

/// A distinct derivative of axes 0 .. l.
struct Prefix {
  std::size_t parent;  // prefix of axes 0 .. l-1
  int a;               // alpha_l
};

/// Partial sum over axes 0 .. l: [prefix][row][node_l] .. [node_0], the innermost padded.
template <int d>
struct Block {
  std::array<Window, d> window{};
  std::size_t row_numbers = 0;  // of one row
  std::size_t rows = 0;
  std::vector<double> data;

  void reset(std::size_t axes, std::size_t prefixes, std::size_t row_count) {
    rows = row_count;
    row_numbers = padded(window[0].size());
    for (std::size_t l = 1; l < axes; ++l) row_numbers *= window[l].size();
    data.assign(prefixes * rows * row_numbers + row_padding, 0.0);
  }
};

/// The boxes between two planes across the last axis, summed over the other axes.
template <int d>
struct Slab {
  Window window;  // of the last axis
  Block<d> block;
  std::vector<std::vector<double>> table;  // [combination * prefixes + prefix]: of the last axis
};

/// Calls body(offset_in_inner, offset_in_outer) for every run of nodes along axis 0 in `inner`, which lies in an outer array
/// (both over axes 0 .. axes-1). `stride` holds numbers from node to node of each axis in the outer array, whose first
/// nodes are `origin`.
template <int d, class Body>
void for_each_run(const std::array<Window, d>& inner, std::size_t axes, const std::array<std::size_t, d>& origin,
                  const std::array<std::size_t, d>& stride, const Body& body) {
  std::size_t runs = 1;
  for (std::size_t l = 1; l < axes; ++l) runs *= inner[l].size();
  const std::size_t run_numbers = padded(inner[0].size());
  for (std::size_t run = 0; run < runs; ++run) {
    std::size_t rest = run, offset = inner[0].begin - origin[0];
    for (std::size_t l = 1; l < axes; ++l) {
      offset += (inner[l].begin + rest % inner[l].size() - origin[l]) * stride[l];
      rest /= inner[l].size();
    }
    body(run * run_numbers, offset);
  }
}

template <int d>
class GridSum {
 public:
  GridSum(const HermitePlan& plan, double sigma, const Boxes<d>& boxes, const std::vector<double>& moments,
          std::size_t columns, const Request<d>& request, const TensorGrid& grid)
      : plan_(plan),
        root_sigma_(std::sqrt(sigma)),
        boxes_(boxes),
        moments_(moments),
        columns_(columns),
        request_(request),
        grid_(grid),
        p_(static_cast<std::size_t>(plan.terms)),
        highest_(*std::max_element(request.highest.begin(), request.highest.end())),
        recurrence_(plan.terms + highest_),
        roots_(binomial_roots(highest_, plan.terms)) {
    find_prefixes();
    for (std::size_t l = 0; l < d; ++l) find_windows(l);
    hull_.resize(boxes_.level[d - 1].index.size());
  }

  void run(int threads, double* values);

  /// Bytes of the tables of all axes but the last.
  double table_bytes() const {
    double numbers = 0;
    for (std::size_t l = 0; l + 1 < d; ++l)
      for (const Window& window : axis_[l].window)
        numbers += static_cast<double>(padded(window.size())) * static_cast<double>(p_) * (request_.highest[l] + 1);
    return 8 * numbers;
  }

 private:
  void find_prefixes();
  void find_windows(std::size_t axis);
  void make_tables(std::size_t axis, int threads);
  std::size_t column_of(std::size_t axis, std::size_t node) const;
  double centre_of(std::size_t axis, std::size_t column) const {
    return boxes_.low[axis] + (static_cast<double>(axis_[axis].column[column]) + 0.5) * boxes_.side;
  }
  /// h~_n at the window's nodes: [n][padded nodes].
  std::vector<double> hermite_rows(std::size_t axis, double centre, const Window& window, int orders) const;
  /// Windows of axes 0 .. level of everything below `node`.
  std::array<Window, d> hull(std::size_t level, std::size_t node) const;
  /// Sum of the children of `node` of level `level` (>= 1) over axes 0 .. level-1, for one column of weights.
  void sum_children(std::size_t level, std::size_t node, std::size_t k, Block<d>& block) const;
  /// factor * g of the last axis for combination q and prefix: [node][b]; empty if the combination lacks the prefix.
  std::vector<double> last_table(std::size_t slab_column, const Window& window, std::size_t q,
                                 std::size_t prefix) const;
  void run_line(int threads, double* values) const;
  void run_slabs(int threads, double* values);
  /// Slabs begin .. end, of `numbers` numbers, for one column of weights.
  std::vector<Slab<d>> sum_batch(std::size_t begin, std::size_t end, std::size_t k, double numbers, int threads) const;
  /// Adds them at all nodes of the grid, by so many updates of a node.
  void add_batch(const std::vector<Slab<d>>& batch, std::size_t k, double updates, int threads, double* values) const;

  const HermitePlan& plan_;
  double root_sigma_;
  const Boxes<d>& boxes_;
  const std::vector<double>& moments_;
  std::size_t columns_;
  const Request<d>& request_;
  const TensorGrid& grid_;
  std::size_t p_;
  int highest_;
  RecurrenceTable recurrence_;
  std::vector<double> roots_;
  std::array<AxisTables, d> axis_;
  std::array<std::vector<Prefix>, d> prefix_;  // of axes 0 .. l
  std::vector<std::size_t> prefix_of_;         // [derivatives]: prefix of axes 0 .. d-2
  std::vector<std::array<Window, d>> hull_;    // [slabs]
};

template <int d>
void GridSum<d>::find_prefixes() {
  for (const auto& alpha : request_.derivatives) {
    std::size_t parent = 0;
    for (std::size_t l = 0; l + 1 < d; ++l) {
      auto& list = prefix_[l];
      std::size_t at = 0;
      while (at < list.size() && !(list[at].parent == parent && list[at].a == alpha[l])) ++at;
      if (at == list.size()) list.push_back({parent, alpha[l]});
      parent = at;
    }
    prefix_of_.push_back(parent);
  }
}

template <int d>
void GridSum<d>::find_windows(std::size_t axis) {
  AxisTables& tables = axis_[axis];
  const std::vector<double>& nodes = grid_.axes[axis];
  tables.column = boxes_.level[axis].index;
  std::sort(tables.column.begin(), tables.column.end());
  tables.column.erase(std::unique(tables.column.begin(), tables.column.end()), tables.column.end());
  const double reach = plan_.reach / root_sigma_ + 0.5 * boxes_.side;  // from a centre
  for (std::size_t c = 0; c < tables.column.size(); ++c) {
    const double centre = centre_of(axis, c);
    const auto begin = std::partition_point(nodes.begin(), nodes.end(), [&](double y) {
      return y - centre < -reach ||
             (plan_.neighbours >= 0 && boxes_.index_at(axis, y) < tables.column[c] - plan_.neighbours);
    });
    const auto end = std::partition_point(begin, nodes.end(), [&](double y) {
      return y - centre <= reach &&
             (plan_.neighbours < 0 || boxes_.index_at(axis, y) <= tables.column[c] + plan_.neighbours);
    });
    tables.window.push_back(
        {static_cast<std::size_t>(begin - nodes.begin()), static_cast<std::size_t>(end - nodes.begin())});
  }
}

template <int d>
std::vector<double> GridSum<d>::hermite_rows(std::size_t axis, double centre, const Window& window, int orders) const {
  const std::size_t stride = padded(window.size());
  std::vector<double> t(stride, 0.0), rows(stride * static_cast<std::size_t>(orders));
  for (std::size_t i = 0; i < window.size(); ++i) t[i] = (grid_.axes[axis][window.begin + i] - centre) * root_sigma_;
  kernels().table({.count = stride,
                   .orders = orders,
                   .t = t.data(),
                   .rows = rows.data(),
                   .stride = stride,
                   .recurrence = recurrence_.view()});
  return rows;
}

template <int d>
void GridSum<d>::make_tables(std::size_t axis, int threads) {
  AxisTables& tables = axis_[axis];
  tables.table.resize(tables.column.size());
  const std::size_t orders = static_cast<std::size_t>(request_.highest[axis]) + 1;
  std::size_t nodes = 0;
  for (const Window& window : tables.window) nodes += padded(window.size());
  const gaussdrift::base::Pieces pieces(tables.column.size(),
                                        static_cast<double>(nodes * orders * p_) * cost::hermite_value);
  gaussdrift::base::parallel_for(pieces, threads, [&](std::size_t c) {
    const Window& window = tables.window[c];
    const std::size_t stride = padded(window.size());
    const std::vector<double> rows =
        hermite_rows(axis, centre_of(axis, c), window, plan_.terms + request_.highest[axis]);
    std::vector<double>& table = tables.table[c];
    table.resize(orders * p_ * stride);
    for (std::size_t a = 0; a < orders; ++a)
      for (std::size_t b = 0; b < p_; ++b)
        for (std::size_t i = 0; i < stride; ++i) {
          const double value = roots_[a * p_ + b] * rows[(a + b) * stride + i];
          table[a * p_ * stride + (axis == 0 ? b * stride + i : i * p_ + b)] = value;
        }
  });
}

template <int d>
std::size_t GridSum<d>::column_of(std::size_t axis, std::size_t node) const {
  const auto& column = axis_[axis].column;
  return static_cast<std::size_t>(std::lower_bound(column.begin(), column.end(), boxes_.level[axis].index[node]) -
                                  column.begin());
}

template <int d>
std::array<Window, d> GridSum<d>::hull(std::size_t level, std::size_t node) const {
  std::array<Window, d> windows{};
  windows[level] = axis_[level].window[column_of(level, node)];
  if (level == 0) return windows;
  for (std::size_t child = boxes_.level[level].first[node]; child < boxes_.level[level].first[node + 1]; ++child) {
    const std::array<Window, d> below = hull(level - 1, child);
    for (std::size_t l = 0; l < level; ++l) windows[l].cover(below[l]);
  }
  return windows;
}

template <int d>
void GridSum<d>::sum_children(std::size_t level, std::size_t node, std::size_t k, Block<d>& block) const {
  const std::size_t axis = level - 1;  // that the children add
  block.window = hull(level, node);
  const std::size_t rows = power(plan_.terms, static_cast<int>(d - level));
  block.reset(level, prefix_[axis].size(), rows);
  if (block.row_numbers == 0) return;

  std::array<std::size_t, d> origin{}, stride{};
  stride[0] = 1;
  for (std::size_t l = 0; l < level; ++l) {
    origin[l] = block.window[l].begin;
    if (l > 0) stride[l] = l == 1 ? padded(block.window[0].size()) : stride[l - 1] * block.window[l - 1].size();
  }

  Block<d> below;
  for (std::size_t child = boxes_.level[level].first[node]; child < boxes_.level[level].first[node + 1]; ++child) {
    const std::size_t column = column_of(axis, child);
    const Window& window = axis_[axis].window[column];
    if (window.size() == 0) continue;
    const std::vector<double>& table = axis_[axis].table[column];
    const std::size_t derivative_numbers = p_ * padded(window.size());
    if (axis == 0) {
      for (std::size_t f = 0; f < prefix_[0].size(); ++f)
        kernels().product({.rows = rows,
                           .depth = p_,
                           .width = window.size(),
                           .b = moments_.data() + (child * columns_ + k) * rows * p_,
                           .b_stride = p_,
                           .d = table.data() + static_cast<std::size_t>(prefix_[0][f].a) * derivative_numbers,
                           .d_stride = padded(window.size()),
                           .c = block.data.data() + f * rows * block.row_numbers + (window.begin - origin[0]),
                           .c_stride = block.row_numbers});
      continue;
    }
    sum_children(axis, child, k, below);
    if (below.row_numbers == 0) continue;
    for (std::size_t f = 0; f < prefix_[axis].size(); ++f)
      for (std::size_t row = 0; row < rows; ++row) {
        const double* from = below.data.data() + (prefix_[axis][f].parent * below.rows + row * p_) * below.row_numbers;
        double* to =
            block.data.data() + (f * rows + row) * block.row_numbers + (window.begin - origin[axis]) * stride[axis];
        for_each_run<d>(below.window, axis, origin, stride, [&](std::size_t inner, std::size_t outer) {
          kernels().product({.rows = window.size(),
                             .depth = p_,
                             .width = below.window[0].size(),
                             .b = table.data() + static_cast<std::size_t>(prefix_[axis][f].a) * derivative_numbers,
                             .b_stride = p_,
                             .d = from + inner,
                             .d_stride = below.row_numbers,
                             .c = to + outer,
                             .c_stride = stride[axis]});
        });
      }
  }
}

template <int d>
std::vector<double> GridSum<d>::last_table(std::size_t column, const Window& window, std::size_t q,
                                           std::size_t prefix) const {
  constexpr std::size_t axis = d - 1;
  std::vector<double> table, rows;
  const std::size_t stride = padded(window.size());
  for (const auto& part : request_.combinations[q]) {
    if (prefix_of_[part.derivative] != prefix) continue;
    if (rows.empty()) {
      rows = hermite_rows(axis, centre_of(axis, column), window, plan_.terms + request_.highest[axis]);
      table.assign(window.size() * p_, 0.0);
    }
    const std::size_t a = static_cast<std::size_t>(request_.derivatives[part.derivative][axis]);
    for (std::size_t i = 0; i < window.size(); ++i)
      for (std::size_t b = 0; b < p_; ++b)
        table[i * p_ + b] += part.factor * roots_[a * p_ + b] * rows[(a + b) * stride + i];
  }
  return table;
}

/// d = 1: the grid is cut into pieces, and every box adds to the nodes of its window.
template <int d>
void GridSum<d>::run_line(int threads, double* values) const {
  constexpr std::size_t piece_nodes = 512;
  const std::size_t nodes = grid_.axes[0].size();
  std::size_t reached = 0;  // by all boxes
  for (const Window& window : axis_[0].window) reached += window.size();
  const double a_node = static_cast<double>(request_.combinations.size() * p_) *
                        (cost::hermite_value + static_cast<double>(columns_) * cost::moment_step);
  const gaussdrift::base::Pieces pieces((nodes + piece_nodes - 1) / piece_nodes, static_cast<double>(reached) * a_node);
  gaussdrift::base::parallel_for(pieces, threads, [&](std::size_t piece) {
    const Window mine{piece * piece_nodes, std::min(nodes, (piece + 1) * piece_nodes)};
    const auto begin = std::partition_point(axis_[0].window.begin(), axis_[0].window.end(),
                                            [&](const Window& w) { return w.end <= mine.begin; });
    for (std::size_t box = static_cast<std::size_t>(begin - axis_[0].window.begin()); box < boxes_.count(); ++box) {
      const Window window{std::max(mine.begin, axis_[0].window[box].begin),
                          std::min(mine.end, axis_[0].window[box].end)};
      if (axis_[0].window[box].begin >= mine.end) break;
      if (window.begin >= window.end) continue;
      for (std::size_t q = 0; q < request_.combinations.size(); ++q) {
        const std::vector<double> table = last_table(box, window, q, 0);
        if (table.empty()) continue;
        for (std::size_t k = 0; k < columns_; ++k) {
          const double* moments = moments_.data() + (box * columns_ + k) * p_;
          double* out = values + (q * columns_ + k) * nodes + window.begin;
          for (std::size_t i = 0; i < window.size(); ++i) {
            double sum = 0;
            for (std::size_t b = 0; b < p_; ++b) sum += moments[b] * table[i * p_ + b];
            out[i] += sum;
          }
        }
      }
    }
  });
}

/// d >= 2: batches of slabs; the slabs of a batch side by side, then the pieces of the grid side by side.
template <int d>
void GridSum<d>::run_slabs(int threads, double* values) {
  const std::size_t slabs = hull_.size();
  std::vector<double> numbers_of(slabs);
  const double a_hull = 20e-9;  // of one box
  gaussdrift::base::parallel_for({slabs, static_cast<double>(boxes_.count()) * a_hull}, threads, [&](std::size_t slab) {
    hull_[slab] = hull(d - 1, slab);
    double numbers = static_cast<double>(prefix_[d - 2].size() * p_ * padded(hull_[slab][0].size()));
    for (std::size_t l = 1; l + 1 < d; ++l) numbers *= static_cast<double>(hull_[slab][l].size());
    numbers_of[slab] = numbers;
  });
  for (std::size_t k = 0; k < columns_; ++k)
    for (std::size_t begin = 0; begin < slabs;) {
      std::size_t end = begin;
      double numbers = 0;
      for (; end < slabs && (end == begin || numbers + numbers_of[end] <= static_cast<double>(batch_numbers)); ++end)
        numbers += numbers_of[end];
      // Lines from boxes, then slabs from lines; and the grid from slabs.
      double updates = 0;
      for (std::size_t slab = begin; slab < end; ++slab)
        updates += numbers_of[slab] * static_cast<double>(hull_[slab][d - 1].size() * request_.combinations.size());
      add_batch(sum_batch(begin, end, k, numbers, threads), k, updates, threads, values);
      begin = end;
    }
}

template <int d>
std::vector<Slab<d>> GridSum<d>::sum_batch(std::size_t begin, std::size_t end, std::size_t k, double numbers,
                                           int threads) const {
  std::vector<Slab<d>> batch(end - begin);
  const std::size_t prefixes = prefix_[d - 2].size();
  const double boxes = static_cast<double>(boxes_.count() * batch.size()) / static_cast<double>(hull_.size()),
               of_box = static_cast<double>(moments_.size()) / static_cast<double>(boxes_.count() * columns_) *
                        cost::product_step;
  const double width = static_cast<double>(padded(hull_[begin][0].size()) * prefixes);
  const double seconds =
      boxes * (cost::product_call + of_box * width) + numbers * static_cast<double>(p_) * cost::product_step;
  gaussdrift::base::parallel_for({batch.size(), seconds}, threads, [&](std::size_t i) {
    Slab<d>& slab = batch[i];
    slab.window = hull_[begin + i][d - 1];
    if (slab.window.size() == 0) return;
    sum_children(d - 1, begin + i, k, slab.block);
    for (std::size_t q = 0; q < request_.combinations.size(); ++q)
      for (std::size_t f = 0; f < prefixes; ++f)
        slab.table.push_back(last_table(column_of(d - 1, begin + i), slab.window, q, f));
  });
  return batch;
}

template <int d>
void GridSum<d>::add_batch(const std::vector<Slab<d>>& batch, std::size_t k, double updates, int threads,
                           double* values) const {
  constexpr std::size_t piece_nodes = d == 2 ? 16 : 4;
  const std::size_t prefixes = prefix_[d - 2].size();
  const std::size_t last_nodes = grid_.axes[d - 1].size();
  std::array<std::size_t, d> origin{}, stride{};
  stride[0] = 1;
  for (std::size_t l = 1; l < d; ++l) stride[l] = stride[l - 1] * grid_.axes[l - 1].size();
  const std::size_t plane = stride[d - 1], size = plane * last_nodes;
  const gaussdrift::base::Pieces pieces((last_nodes + piece_nodes - 1) / piece_nodes, updates * cost::product_step);
  gaussdrift::base::parallel_for(pieces, threads, [&](std::size_t piece) {
    const Window mine{piece * piece_nodes, std::min(last_nodes, (piece + 1) * piece_nodes)};
    for (const Slab<d>& slab : batch) {
      const Window window{std::max(mine.begin, slab.window.begin), std::min(mine.end, slab.window.end)};
      if (window.begin >= window.end || slab.block.row_numbers == 0) continue;
      for (std::size_t q = 0; q < request_.combinations.size(); ++q)
        for (std::size_t f = 0; f < prefixes; ++f) {
          const std::vector<double>& table = slab.table[q * prefixes + f];
          if (table.empty()) continue;
          const double* from = slab.block.data.data() + f * p_ * slab.block.row_numbers;
          double* to = values + (q * columns_ + k) * size + window.begin * plane;
          for_each_run<d>(slab.block.window, d - 1, origin, stride, [&](std::size_t inner, std::size_t outer) {
            kernels().product({.rows = window.size(),
                               .depth = p_,
                               .width = slab.block.window[0].size(),
                               .b = table.data() + (window.begin - slab.window.begin) * p_,
                               .b_stride = p_,
                               .d = from + inner,
                               .d_stride = slab.block.row_numbers,
                               .c = to + outer,
                               .c_stride = plane});
          });
        }
    }
  });
}

template <int d>
void GridSum<d>::run(int threads, double* values) {
  if constexpr (d == 1) {
    run_line(threads, values);
  } else {
    for (std::size_t l = 0; l + 1 < d; ++l) make_tables(l, threads);
    run_slabs(threads, values);
  }
}

}  // namespace

template <int d>
double HermiteSum<d>::grid_bytes(const Request<d>& request, const TensorGrid& grid) const {
  if (request.derivatives.empty() || boxes_.count() == 0) return 0;
  const GridSum<d> sum(plan_, sigma_, boxes_, moments_, columns_, request, grid);
  double slab = static_cast<double>(request.derivatives.size()) * plan_.terms;
  for (std::size_t l = 0; l + 1 < d; ++l) slab *= static_cast<double>(grid.axes[l].size());
  const double slabs = static_cast<double>(boxes_.level[d - 1].index.size());
  return sum.table_bytes() + 8 * (2 * slab + std::min(slabs * slab, slab + static_cast<double>(batch_numbers)));
}

template <int d>
void HermiteSum<d>::evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const {
  std::fill_n(values, request.combinations.size() * columns_ * grid.size(), 0.0);
  if (request.derivatives.empty() || columns_ == 0 || grid.size() == 0 || boxes_.count() == 0) return;
  GridSum<d>(plan_, sigma_, boxes_, moments_, columns_, request, grid).run(threads_, values);
}

#define FGTD_INSTANTIATE(d)                                                              \
  template double HermiteSum<d>::grid_bytes(const Request<d>&, const TensorGrid&) const; \
  template void HermiteSum<d>::evaluate(const Request<d>&, const TensorGrid&, double*) const;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
