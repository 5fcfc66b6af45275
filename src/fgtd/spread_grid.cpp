// The filter of `spread`: banded matrices along one axis after the other, the last first, so that the result is written
// in pieces of its last axis that need nothing from each other. For d = 3
//   T2[z][k1 k0]  = sum_{k2} f_{a2}(z - k2) lattice[k2][k1 k0]        shared by all derivatives with the same a2
//   T1[z y][k0]   = sum_{k1} f_{a1}(y - k1) T2[z][k1 k0]              ... the same (a1, a2)
//   S[z y][x]    += sum_{k0} T1[z y][k0] f_{a0}(x - k0)
// over the nodes within reach of the brick; nodes of the grid are taken in groups whose bands overlap.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "fgtd/spread.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t inner_group = 24;  // nodes of axis 0 in a product: three vectors of the widest kind
constexpr std::size_t outer_group = 8;   // nodes of another axis in a product

std::size_t padded(std::size_t n) { return (n + row_padding - 1) / row_padding * row_padding; }

/// Nodes of the last axis in a piece.
template <int d>
constexpr std::size_t piece_nodes() {
  return d == 1 ? 64 * inner_group : d == 2 ? 32 : 8;
}

/// Targets begin .. begin + size against lattice nodes first .. first + depth of a brick.
struct Group {
  std::size_t begin, size, first, depth;
  std::size_t offset;  // in the matrices
};

/// The filter between one axis of the targets and one of a brick.
struct AxisMatrix {
  std::size_t begin = 0, end = 0;  // targets within reach
  std::vector<Group> groups;       //
  std::vector<std::vector<double>>
      entries;  // [a]: a group has [depth][padded(size)] on axis 0, [size][depth] on others
};

/// Distinct derivatives of axes l .. d-1.
struct Suffix {
  std::size_t parent;  // of axes l+1 .. d-1
  int a;               // alpha_l
};

template <int d>
class Filter {
 public:
  Filter(const FilterJob<d>& job, const FilterTargets<d>& targets, std::size_t row_stride, std::size_t output_stride,
         double* values)
      : job_(job), targets_(targets), output_stride_(output_stride), values_(values) {
    stride_[0] = 1;
    if constexpr (d > 1) stride_[1] = row_stride;
    for (std::size_t l = 2; l < d; ++l) stride_[l] = stride_[l - 1] * targets.size(l - 1);
    last_stride_ = d == 1 ? 1 : stride_[d - 1];
    find_suffixes();
    matrix_.resize(job.bricks.size());
    for (std::size_t b = 0; b < job.bricks.size(); ++b)
      for (std::size_t l = 0; l < d; ++l) matrix_[b][l] = make_matrix(*job.bricks[b], l);
  }

  void run() {
    const std::size_t nodes = targets_.size(d - 1);
    constexpr std::size_t piece = piece_nodes<d>();
    gaussdrift::base::parallel_for((nodes + piece - 1) / piece, job_.threads,
                                   [&](std::size_t i) { run_piece(i * piece, std::min(nodes, (i + 1) * piece)); });
  }

 private:
  void find_suffixes();
  AxisMatrix make_matrix(const Brick<d>& brick, std::size_t axis) const;
  std::pair<std::int64_t, std::int64_t> band(std::size_t axis, std::size_t i) const;
  double entry(int a, std::size_t axis, std::size_t i, std::int64_t k) const;
  void run_piece(std::size_t begin, std::size_t end) const;
  void descend(std::size_t b, std::size_t k, std::size_t axis, const std::vector<const double*>& in, std::size_t begin,
               std::size_t end, std::size_t offset, std::array<std::vector<double>, d>& scratch) const;
  void write_rows(std::size_t b, std::size_t k, const std::vector<const double*>& in, std::size_t rows,
                  std::size_t begin, std::size_t end, std::size_t offset, std::vector<double>& scratch) const;
  void clear(std::size_t begin, std::size_t end) const;

  const FilterJob<d>& job_;
  const FilterTargets<d>& targets_;
  std::size_t output_stride_;
  double* values_;
  std::array<std::size_t, d> stride_{};  // numbers from node to node of the result
  std::size_t last_stride_;
  std::array<std::vector<Suffix>, d> suffix_;  // [axis], axis >= 1
  std::vector<std::size_t> leaf_;              // of each derivative, in suffix_[1]
  std::vector<std::array<AxisMatrix, d>> matrix_;
};

template <int d>
void Filter<d>::find_suffixes() {
  std::vector<std::size_t> at(job_.request.derivatives.size(), 0);
  for (std::size_t l = d; l-- > 1;) {
    auto& list = suffix_[l];
    for (std::size_t i = 0; i < at.size(); ++i) {
      const Suffix suffix{at[i], job_.request.derivatives[i][l]};
      const auto place = std::find_if(list.begin(), list.end(), [&](const Suffix& other) {
        return other.parent == suffix.parent && other.a == suffix.a;
      });
      at[i] = static_cast<std::size_t>(place - list.begin());
      if (place == list.end()) list.push_back(suffix);
    }
  }
  leaf_ = std::move(at);
}

/// Lattice nodes within reach of target i, first and last.
template <int d>
std::pair<std::int64_t, std::int64_t> Filter<d>::band(std::size_t axis, std::size_t i) const {
  if (targets_.on_lattice) {
    const std::int64_t node = targets_.node[axis][i], reach = job_.filter.lattice_reach();
    return {node - reach, node + reach};
  }
  const double node = targets_.coordinate[axis][i] / job_.frame.spacing;
  const double reach = job_.filter.reach() / job_.filter.spacing();
  constexpr double farthest = 0x1p60;
  return {static_cast<std::int64_t>(std::ceil(std::clamp(node - reach, -farthest, farthest))),
          static_cast<std::int64_t>(std::floor(std::clamp(node + reach, -farthest, farthest)))};
}

template <int d>
double Filter<d>::entry(int a, std::size_t axis, std::size_t i, std::int64_t k) const {
  if (targets_.on_lattice) return job_.filter.lattice_filter(a, static_cast<int>(targets_.node[axis][i] - k));
  return job_.filter.filter(a, job_.frame.from_node(targets_.coordinate[axis][i], k) * std::sqrt(job_.sigma));
}

template <int d>
AxisMatrix Filter<d>::make_matrix(const Brick<d>& brick, std::size_t axis) const {
  AxisMatrix matrix;
  const std::size_t count = targets_.size(axis);
  const std::int64_t first = brick.first[axis], last = first + static_cast<std::int64_t>(brick.nodes[axis]) - 1;
  const std::size_t largest = axis == 0 ? inner_group : outer_group;
  const std::int64_t width = 2 * static_cast<std::int64_t>(std::ceil(job_.filter.reach() / job_.filter.spacing())) + 1;
  std::size_t numbers = 0;
  matrix.begin = matrix.end = 0;
  for (std::size_t i = 0; i < count; ++i) {
    auto [low, high] = band(axis, i);
    low = std::max(low, first);
    high = std::min(high, last);
    if (low > high) {
      if (matrix.groups.empty()) continue;
      if (band(axis, i).first > last) break;
      low = high = std::clamp(low, first, last);  // between two nodes of a coarse lattice: nothing is within reach
    }
    if (matrix.groups.empty()) matrix.begin = i;
    matrix.end = i + 1;
    const std::size_t from = static_cast<std::size_t>(low - first), to = static_cast<std::size_t>(high - first) + 1;
    if (!matrix.groups.empty()) {
      Group& group = matrix.groups.back();
      const std::size_t depth = std::max(to, group.first + group.depth) - std::min(from, group.first);
      if (group.size < largest && depth <= static_cast<std::size_t>(2 * width)) {
        group.depth = depth;
        group.first = std::min(from, group.first);
        ++group.size;
        continue;
      }
    }
    matrix.groups.push_back({i, 1, from, to - from, 0});
  }
  for (Group& group : matrix.groups) {
    group.offset = numbers;
    numbers += group.depth * (axis == 0 ? padded(group.size) : group.size);
  }
  matrix.entries.resize(static_cast<std::size_t>(job_.request.highest[axis]) + 1);
  for (std::size_t a = 0; a < matrix.entries.size(); ++a) {
    if (std::none_of(job_.request.derivatives.begin(), job_.request.derivatives.end(),
                     [&](const Derivative<d>& alpha) { return alpha[axis] == static_cast<int>(a); }))
      continue;
    auto& entries = matrix.entries[a];
    entries.assign(numbers, 0.0);
    for (const Group& group : matrix.groups)
      for (std::size_t i = 0; i < group.size; ++i)
        for (std::size_t k = 0; k < group.depth; ++k) {
          const double value =
              entry(static_cast<int>(a), axis, group.begin + i, first + static_cast<std::int64_t>(group.first + k));
          entries[group.offset + (axis == 0 ? k * padded(group.size) + i : i * group.depth + k)] = value;
        }
  }
  return matrix;
}

/// Nodes begin .. end of the last axis become zero.
template <int d>
void Filter<d>::clear(std::size_t begin, std::size_t end) const {
  const std::size_t outputs = job_.request.combinations.size() * job_.columns;
  for (std::size_t output = 0; output < outputs; ++output)
    std::fill(values_ + output * output_stride_ + begin * last_stride_,
              values_ + output * output_stride_ + end * last_stride_, 0.0);
}

template <int d>
void Filter<d>::run_piece(std::size_t begin, std::size_t end) const {
  std::array<std::vector<double>, d> scratch;
  bool cleared = false;
  for (std::size_t b = 0; b < job_.bricks.size(); ++b) {
    const auto& matrix = matrix_[b];
    if (std::any_of(matrix.begin(), matrix.end(), [](const AxisMatrix& axis) { return axis.groups.empty(); })) continue;
    const std::size_t from = std::max(begin, matrix[d - 1].begin), to = std::min(end, matrix[d - 1].end);
    if (from >= to) continue;
    if (!cleared) clear(begin, end);
    cleared = true;
    for (std::size_t k = 0; k < job_.columns; ++k) {
      const std::vector<const double*> in{job_.lattice[b] + k * job_.bricks[b]->size()};
      if constexpr (d == 1) {
        write_rows(b, k, in, 1, from, to, 0, scratch[0]);
      } else {
        descend(b, k, d - 1, in, from, to, 0, scratch);
      }
    }
  }
  if (!cleared) clear(begin, end);
}

/// From sums over axes axis+1 .. d-1, one array for every suffix, to those over `axis` at its targets begin .. end.
template <int d>
void Filter<d>::descend(std::size_t b, std::size_t k, std::size_t axis, const std::vector<const double*>& in,
                        std::size_t begin, std::size_t end, std::size_t offset,
                        std::array<std::vector<double>, d>& scratch) const {
  const Brick<d>& brick = *job_.bricks[b];
  const AxisMatrix& matrix = matrix_[b][axis];
  std::size_t inner = 1;
  for (std::size_t l = 0; l < axis; ++l) inner *= brick.nodes[l];
  const std::size_t rows = end - begin;
  auto& sums = scratch[axis];  // [suffix][rows][inner]
  sums.assign(suffix_[axis].size() * rows * inner + row_padding, 0.0);
  for (std::size_t s = 0; s < suffix_[axis].size(); ++s) {
    const Suffix& suffix = suffix_[axis][s];
    const auto& entries = matrix.entries[static_cast<std::size_t>(suffix.a)];
    for (const Group& group : matrix.groups) {
      const std::size_t from = std::max(begin, group.begin), to = std::min(end, group.begin + group.size);
      if (from >= to) continue;
      kernels().product({.rows = to - from,
                         .depth = group.depth,
                         .width = inner,
                         .b = entries.data() + group.offset + (from - group.begin) * group.depth,
                         .b_stride = group.depth,
                         .d = in[suffix.parent] + group.first * inner,
                         .d_stride = inner,
                         .c = sums.data() + (s * rows + from - begin) * inner,
                         .c_stride = inner});
    }
  }
  std::vector<const double*> out(suffix_[axis].size());
  if (axis == 1) {
    for (std::size_t s = 0; s < out.size(); ++s) out[s] = sums.data() + s * rows * inner;
    const AxisMatrix& first = matrix_[b][0];
    write_rows(b, k, out, rows, first.begin, first.end, offset + begin * stride_[1], scratch[0]);
    return;
  }
  const AxisMatrix& below = matrix_[b][axis - 1];
  for (std::size_t i = 0; i < rows; ++i) {
    for (std::size_t s = 0; s < out.size(); ++s) out[s] = sums.data() + (s * rows + i) * inner;
    descend(b, k, axis - 1, out, below.begin, below.end, offset + (begin + i) * stride_[axis], scratch);
  }
}

/// The last pass, along axis 0 to its targets begin .. end, added to the result. Matrices are scaled by the factors of
/// the combinations.
template <int d>
void Filter<d>::write_rows(std::size_t b, std::size_t k, const std::vector<const double*>& in, std::size_t rows,
                           std::size_t begin, std::size_t end, std::size_t offset, std::vector<double>& scratch) const {
  const AxisMatrix& matrix = matrix_[b][0];
  const std::size_t row = job_.bricks[b]->nodes[0];
  for (const Group& group : matrix.groups) {
    const std::size_t from = std::max(begin, group.begin), to = std::min(end, group.begin + group.size);
    if (from >= to) continue;
    const std::size_t width = padded(group.size);
    for (std::size_t q = 0; q < job_.request.combinations.size(); ++q)
      for (const auto& part : job_.request.combinations[q]) {
        const int a = job_.request.derivatives[part.derivative][0];
        const double* entries = matrix.entries[static_cast<std::size_t>(a)].data() + group.offset;
        if (part.factor != 1) {
          scratch.resize(std::max(scratch.size(), group.depth * width));
          for (std::size_t i = 0; i < group.depth * width; ++i) scratch[i] = entries[i] * part.factor;
          entries = scratch.data();
        }
        kernels().product({.rows = rows,
                           .depth = group.depth,
                           .width = to - from,
                           .b = in[d == 1 ? 0 : leaf_[part.derivative]] + group.first,
                           .b_stride = row,
                           .d = entries + (from - group.begin),
                           .d_stride = width,
                           .c = values_ + (q * job_.columns + k) * output_stride_ + offset + from,
                           .c_stride = stride_[d == 1 ? 0 : 1]});
      }
  }
}

}  // namespace

template <int d>
void apply_filter(const FilterJob<d>& job, const FilterTargets<d>& targets, std::size_t row_stride,
                  std::size_t output_stride, double* values) {
  Filter<d>(job, targets, row_stride, output_stride, values).run();
}

/// Matrices: every target's band at most doubled by its group and padded to eight; and the sums of each thread.
template <int d>
double filter_bytes(const FilterJob<d>& job, const std::array<double, d>& sizes, bool on_lattice) {
  const double reach = on_lattice ? job.filter.lattice_reach() : std::ceil(job.filter.reach() / job.filter.spacing());
  double matrices = 0, largest = 0;
  for (const Brick<d>* brick : job.bricks) {
    double inner = 1;
    for (std::size_t l = 0; l < d; ++l) {
      const double nodes = static_cast<double>(brick->nodes[l]);
      const double within = std::min(sizes[l], on_lattice ? nodes + 2 * reach : sizes[l]);
      matrices += (l == 0 ? 3.0 : 2.0) * (job.request.highest[l] + 1) * within * std::min(nodes, 2 * (2 * reach + 1));
    }
    double sums = 0, suffixes = static_cast<double>(job.request.derivatives.size());
    for (std::size_t l = 1; l < d; ++l) {
      inner *= static_cast<double>(brick->nodes[l - 1]);
      const double rows = l + 1 == d ? static_cast<double>(piece_nodes<d>()) : sizes[l];
      sums += suffixes * std::min(rows, sizes[l]) * inner;
    }
    largest = std::max(largest, sums);
  }
  return 8 * (matrices + gaussdrift::base::resolve_threads(job.threads) * largest);
}

template <int d>
void SpreadSum<d>::evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const {
  if (grid.size() == 0 || request.combinations.empty() || columns_ == 0) return;
  FilterJob<d> job{*filter_, layout_.frame, sigma_, request, columns_, {}, {}, threads_};
  FilterTargets<d> targets;
  for (const auto& brick : layout_.bricks) {
    job.bricks.push_back(&brick);
    job.lattice.push_back(lattice_.data() + columns_ * brick.offset);
  }
  for (std::size_t l = 0; l < d; ++l)
    for (const double y : grid.axes[l]) targets.coordinate[l].push_back(y - layout_.frame.anchor[l]);
  apply_filter<d>(job, targets, grid.axes[0].size(), grid.size(), values);
}

template <int d>
double SpreadSum<d>::grid_bytes(const Request<d>& request, const TensorGrid& grid) const {
  FilterJob<d> job{*filter_, layout_.frame, sigma_, request, columns_, {}, {}, threads_};
  std::array<double, d> sizes;
  for (std::size_t l = 0; l < d; ++l) sizes[l] = static_cast<double>(grid.axes[l].size());
  for (const auto& brick : layout_.bricks) job.bricks.push_back(&brick);
  return filter_bytes<d>(job, sizes, false);
}

#define FGTD_INSTANTIATE(d)                                                                                       \
  template void apply_filter<d>(const FilterJob<d>&, const FilterTargets<d>&, std::size_t, std::size_t, double*); \
  template double filter_bytes<d>(const FilterJob<d>&, const std::array<double, d>&, bool);                       \
  template void SpreadSum<d>::evaluate(const Request<d>&, const TensorGrid&, double*) const;                      \
  template double SpreadSum<d>::grid_bytes(const Request<d>&, const TensorGrid&) const;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
