// The filter of `spread`: banded matrices along one axis after the other, the last first, so that the result is written
// in pieces of its last axis that need nothing from each other. For d = 3
//   T2[z][k1 k0]  = sum_{k2} f_{a2}(z - k2) lattice[k2][k1 k0]        shared by all derivatives with the same a2
//   T1[z y][k0]   = sum_{k1} f_{a1}(y - k1) T2[z][k1 k0]              ... the same (a1, a2)
//   S[z y][x]    += sum_{k0} T1[z y][k0] f_{a0}(x - k0)
// over the nodes within reach of the brick; nodes of the grid are taken in groups whose bands overlap. T1 exists for
// a few y at a time, and all values and derivatives of these rows are written while it is in the cache.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "fgtd/spread/sum.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t inner_group = 24;  // nodes of axis 0 in a product: three vectors of the widest kind
constexpr std::size_t outer_group = 8;   // nodes of another axis in a product

/// Rows that are written together, so that they share the parts of the last matrix in the nearest cache; their sums, of
/// so many numbers a row, stay in the next.
constexpr std::size_t most_rows = 32;
std::size_t rows_at_once(std::size_t numbers) {
  constexpr std::size_t cached = 8192;
  return std::clamp(cached / std::max<std::size_t>(1, numbers) / outer_group * outer_group, outer_group, most_rows);
}

std::size_t padded(std::size_t n) { return (n + row_padding - 1) / row_padding * row_padding; }

/// Nodes of the last axis in a piece.
template <int d>
constexpr std::size_t piece_nodes() {
  return d == 1 ? 64 * inner_group : d == 2 ? 32 : 8;
}

constexpr std::size_t columns_at_once = 96;  // whose rows, within reach of a group, fit the nearest cache

/// Asks for numbers that are needed soon.
void fetch(const double* block, std::size_t rows, std::size_t stride, std::size_t columns) {
  constexpr std::size_t line = 8;
  for (std::size_t i = 0; i < rows; ++i)
    for (std::size_t x = 0; x < columns; x += line) __builtin_prefetch(block + i * stride + x);
}

/// Targets begin .. begin + size against lattice nodes first .. first + depth of a brick.
struct Group {
  std::size_t begin, size, first, depth;
  std::size_t offset;  // in the matrices
};

/// The filter between one axis of the targets and one of a brick.
struct AxisMatrix {
  std::size_t begin = 0, end = 0;  // targets within reach
  std::vector<Group> groups;
  std::vector<std::size_t> group_of;  // of target begin + i
  /// Of axis 0 for every distinct (alpha_0, factor) of the request: a group has [depth][padded(size)]; of other axes
  /// for every alpha_l: [size][depth].
  std::vector<std::vector<double>> entries;
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
      : job_(job),
        targets_(targets),
        output_stride_(output_stride),
        values_(values),
        row_length_(row_stride),
        alone_(job.bricks.size() == 1 && !job.add) {
    stride_[0] = 1;
    if constexpr (d > 1) stride_[1] = row_stride;
    for (std::size_t l = 2; l < d; ++l) stride_[l] = stride_[l - 1] * targets.size(l - 1);
    find_suffixes();
    find_factors();
    matrix_.resize(job.bricks.size());
    for (std::size_t b = 0; b < job.bricks.size(); ++b)
      for (std::size_t l = 0; l < d; ++l) matrix_[b][l] = make_matrix(*job.bricks[b], l);
  }

  void run() {
    const std::size_t nodes = targets_.size(d - 1);
    constexpr std::size_t piece = piece_nodes<d>();
    gaussdrift::base::parallel_for({(nodes + piece - 1) / piece, seconds()}, job_.threads,
                                   [&](std::size_t i) { run_piece(i * piece, std::min(nodes, (i + 1) * piece)); });
  }

 private:
  double seconds() const;
  void find_suffixes();
  void find_factors();
  AxisMatrix group_targets(const Brick<d>& brick, std::size_t axis) const;
  AxisMatrix make_matrix(const Brick<d>& brick, std::size_t axis) const;
  std::pair<std::int64_t, std::int64_t> band(std::size_t axis, std::size_t i) const;
  double entry(int a, std::size_t axis, std::size_t i, std::int64_t k) const;
  void run_piece(std::size_t begin, std::size_t end) const;
  void sum_axis(std::size_t axis, const AxisMatrix& matrix, const std::vector<const double*>& in, std::size_t first,
                std::size_t last, std::size_t inner, double* sums) const;
  void descend(std::size_t b, std::size_t k, std::size_t axis, const std::vector<const double*>& in, std::size_t begin,
               std::size_t end, std::size_t offset, std::array<Buffer<double>, d>& scratch) const;
  void write_rows(std::size_t b, std::size_t k, const std::vector<const double*>& in, std::size_t rows,
                  std::size_t begin, std::size_t end, std::size_t offset) const;
  void clear(std::size_t k, std::size_t axis, std::size_t begin, std::size_t end, std::size_t offset) const;

  const FilterJob<d>& job_;
  const FilterTargets<d>& targets_;
  std::size_t output_stride_;
  double* values_;
  std::array<std::size_t, d> stride_{};  // numbers from node to node of the result
  std::size_t row_length_;
  std::array<std::vector<Suffix>, d> suffix_;         // [axis], axis >= 1
  std::vector<std::size_t> leaf_;                     // of each derivative, in suffix_[1]
  std::vector<std::pair<int, double>> factor_;        // distinct (alpha_0, factor)
  std::vector<std::vector<std::size_t>> row_matrix_;  // [combination][part], in factor_
  std::vector<std::array<AxisMatrix, d>> matrix_;
  /// One brick: every row is set to zero when it is written first, while it is in the cache; else beforehand, or not.
  bool alone_;
};

/// Roughly; a sum over the nodes in reach for every target of the axes that are done and every node of the others.
template <int d>
double Filter<d>::seconds() const {
  const double reach = job_.filter.reach() / job_.filter.spacing();
  double all = 0;
  for (const Brick<d>* brick : job_.bricks) {
    double targets = 1, inner = static_cast<double>(brick->size());
    for (std::size_t l = d; l-- > 0;) {
      targets *= static_cast<double>(targets_.size(l));
      inner /= static_cast<double>(brick->nodes[l]);
      const std::size_t derivatives = l == 0 ? job_.request.derivatives.size() : suffix_[l].size();
      all += targets * inner * static_cast<double>(derivatives) * 3 * reach * cost::spread_step;
    }
    all += targets * static_cast<double>(job_.request.combinations.size()) * cost::spread_value;
  }
  return all * static_cast<double>(job_.columns);
}

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

template <int d>
void Filter<d>::find_factors() {
  for (const auto& combination : job_.request.combinations) {
    auto& matrices = row_matrix_.emplace_back();
    for (const auto& part : combination) {
      const std::pair<int, double> factor{job_.request.derivatives[part.derivative][0], part.factor};
      const auto place = std::find(factor_.begin(), factor_.end(), factor);
      matrices.push_back(static_cast<std::size_t>(place - factor_.begin()));
      if (place == factor_.end()) factor_.push_back(factor);
    }
  }
}

/// Lattice nodes within reach of target i, first and last.
template <int d>
std::pair<std::int64_t, std::int64_t> Filter<d>::band(std::size_t axis, std::size_t i) const {
  if (targets_.on_lattice) {
    const std::int64_t node = targets_.node[axis][i], reach = job_.filter.lattice_reach();
    return {node - reach, node + reach};
  }
  const double node = targets_.coordinate[axis][i] / job_.frame.spacing;
  const double reach = targets_.by_window ? 0.5 * job_.frame.width : job_.filter.reach() / job_.filter.spacing();
  constexpr double farthest = 0x1p60;
  return {static_cast<std::int64_t>(std::ceil(std::clamp(node - reach, -farthest, farthest))),
          static_cast<std::int64_t>(std::floor(std::clamp(node + reach, -farthest, farthest)))};
}

template <int d>
double Filter<d>::entry(int a, std::size_t axis, std::size_t i, std::int64_t k) const {
  if (targets_.on_lattice) return job_.filter.lattice_filter(a, static_cast<int>(targets_.node[axis][i] - k));
  if (targets_.by_window)
    return job_.filter.window(job_.frame.from_node(targets_.coordinate[axis][i], k) * job_.frame.inverse_spacing);
  return job_.filter.filter(a, job_.frame.from_node(targets_.coordinate[axis][i], k) * std::sqrt(job_.sigma));
}

/// A matrix without entries: neighbouring targets with the nodes that any of them needs.
template <int d>
AxisMatrix Filter<d>::group_targets(const Brick<d>& brick, std::size_t axis) const {
  AxisMatrix matrix;
  const std::size_t count = targets_.size(axis);
  const std::int64_t first = brick.first[axis], last = first + static_cast<std::int64_t>(brick.nodes[axis]) - 1;
  const std::size_t largest = axis == 0 ? inner_group : outer_group;
  const std::int64_t width = 2 * static_cast<std::int64_t>(std::ceil(job_.filter.reach() / job_.filter.spacing())) + 1;
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
      if (i % largest != 0 && depth <= static_cast<std::size_t>(2 * width)) {
        group.depth = depth;
        group.first = std::min(from, group.first);
        ++group.size;
        matrix.group_of.push_back(matrix.groups.size() - 1);
        continue;
      }
    }
    matrix.group_of.push_back(matrix.groups.size());
    matrix.groups.push_back({i, 1, from, to - from, 0});
  }
  return matrix;
}

template <int d>
AxisMatrix Filter<d>::make_matrix(const Brick<d>& brick, std::size_t axis) const {
  AxisMatrix matrix = group_targets(brick, axis);
  std::size_t numbers = 0;
  for (Group& group : matrix.groups) {
    group.offset = numbers;
    numbers += group.depth * (axis == 0 ? padded(group.size) : group.size);
  }
  const auto fill = [&](std::vector<double>& entries, int a, double factor) {
    entries.assign(numbers, 0.0);
    for (const Group& group : matrix.groups)
      for (std::size_t i = 0; i < group.size; ++i)
        for (std::size_t k = 0; k < group.depth; ++k) {
          const double value =
              factor * entry(a, axis, group.begin + i, brick.first[axis] + static_cast<std::int64_t>(group.first + k));
          entries[group.offset + (axis == 0 ? k * padded(group.size) + i : i * group.depth + k)] = value;
        }
  };
  if (axis == 0) {
    matrix.entries.resize(factor_.size());
    for (std::size_t f = 0; f < factor_.size(); ++f) fill(matrix.entries[f], factor_[f].first, factor_[f].second);
    return matrix;
  }
  matrix.entries.resize(static_cast<std::size_t>(job_.request.highest[axis]) + 1);
  for (const Suffix& suffix : suffix_[axis]) {
    auto& entries = matrix.entries[static_cast<std::size_t>(suffix.a)];
    if (entries.empty()) fill(entries, suffix.a, 1);
  }
  return matrix;
}

/// Everything at nodes begin .. end of an axis becomes zero, for column k.
template <int d>
void Filter<d>::clear(std::size_t k, std::size_t axis, std::size_t begin, std::size_t end, std::size_t offset) const {
  if (begin >= end) return;
  // with the gap behind a row
  const std::size_t length = axis == 0 && end == targets_.size(0) ? row_length_ - begin : (end - begin) * stride_[axis];
  for (std::size_t q = 0; q < job_.request.combinations.size(); ++q)
    std::fill_n(values_ + (q * job_.columns + k) * output_stride_ + offset + begin * stride_[axis], length, 0.0);
}

template <int d>
void Filter<d>::run_piece(std::size_t begin, std::size_t end) const {
  std::array<Buffer<double>, d> scratch;
  for (std::size_t k = 0; k < job_.columns; ++k) {
    if (!alone_ && !job_.add) clear(k, d - 1, begin, end, 0);
    for (std::size_t b = 0; b < job_.bricks.size(); ++b) {
      const auto& matrix = matrix_[b];
      const bool reached =
          std::none_of(matrix.begin(), matrix.end(), [](const AxisMatrix& axis) { return axis.groups.empty(); });
      const std::size_t from = reached ? std::clamp(matrix[d - 1].begin, begin, end) : end,
                        to = reached ? std::clamp(matrix[d - 1].end, from, end) : end;
      if (alone_) {
        clear(k, d - 1, begin, from, 0);
        clear(k, d - 1, to, end, 0);
      }
      if (from == to) continue;
      const std::vector<const double*> in{job_.lattice[b] + k * job_.bricks[b]->size()};
      if constexpr (d == 1) {
        if (alone_) clear(k, 0, from, to, 0);
        write_rows(b, k, in, 1, from, to, 0);
      } else {
        descend(b, k, d - 1, in, from, to, 0, scratch);
      }
    }
  }
}

/// Sums over `axis` at its targets first .. last: [suffix][target][inner].
template <int d>
void Filter<d>::sum_axis(std::size_t axis, const AxisMatrix& matrix, const std::vector<const double*>& in,
                         std::size_t first, std::size_t last, std::size_t inner, double* sums) const {
  const std::size_t size = (last - first) * inner;
  // Rows along axis 1 are short. Later axes take them from all over the lattice, for which the processor needs a hint.
  const std::size_t block = axis == 1 ? inner : columns_at_once;
  for (std::size_t x = 0; x < inner; x += block) {
    const std::size_t columns = std::min(block, inner - x);
    for (std::size_t s = 0; s < suffix_[axis].size(); ++s) {
      const Suffix& suffix = suffix_[axis][s];
      const double* entries = matrix.entries[static_cast<std::size_t>(suffix.a)].data();
      double* const to_sums = sums + s * size + x;
      for (std::size_t i = 0; i < last - first; ++i) std::fill_n(to_sums + i * inner, columns, 0.0);
      for (std::size_t g = matrix.group_of[first - matrix.begin]; g < matrix.groups.size(); ++g) {
        const Group& group = matrix.groups[g];
        const std::size_t from = std::max(first, group.begin), to = std::min(last, group.begin + group.size);
        if (from >= to) break;
        const double* const from_sums = in[suffix.parent] + group.first * inner + x;
        if (axis > 1 && x + block < inner)
          fetch(from_sums + block, group.depth, inner, std::min(block, inner - x - block));
        kernels().product({.rows = to - from,
                           .depth = group.depth,
                           .width = columns,
                           .b = entries + group.offset + (from - group.begin) * group.depth,
                           .b_stride = group.depth,
                           .d = from_sums,
                           .d_stride = inner,
                           .c = to_sums + (from - first) * inner,
                           .c_stride = inner});
      }
    }
  }
}

/// From sums over axes axis+1 .. d-1, one array for every suffix, to those over `axis` at its targets begin .. end,
/// some at a time.
template <int d>
void Filter<d>::descend(std::size_t b, std::size_t k, std::size_t axis, const std::vector<const double*>& in,
                        std::size_t begin, std::size_t end, std::size_t offset,
                        std::array<Buffer<double>, d>& scratch) const {
  const Brick<d>& brick = *job_.bricks[b];
  const AxisMatrix& matrix = matrix_[b][axis];
  const AxisMatrix& below = matrix_[b][axis - 1];
  std::size_t inner = 1;
  for (std::size_t l = 0; l < axis; ++l) inner *= brick.nodes[l];
  auto& sums = scratch[axis];  // [suffix][rows][inner]
  std::vector<const double*> out(suffix_[axis].size());
  const std::size_t together = axis == 1 ? rows_at_once(inner * out.size()) : outer_group;
  for (std::size_t first = begin; first < end;) {
    const std::size_t last = std::min(end, (first / together + 1) * together), size = (last - first) * inner;
    sums.resize(std::max(sums.size(), out.size() * size + row_padding));
    std::fill_n(sums.begin() + static_cast<std::ptrdiff_t>(out.size() * size), row_padding, 0.0);
    sum_axis(axis, matrix, in, first, last, inner, sums.data());
    if (axis == 1) {
      for (std::size_t s = 0; s < out.size(); ++s) out[s] = sums.data() + s * size;
      write_rows(b, k, out, last - first, below.begin, below.end, offset + first * stride_[1]);
    } else {
      for (std::size_t i = first; i < last; ++i) {
        const std::size_t here = offset + i * stride_[axis];
        for (std::size_t s = 0; s < out.size(); ++s) out[s] = sums.data() + s * size + (i - first) * inner;
        if (alone_) {
          clear(k, axis - 1, 0, below.begin, here);
          clear(k, axis - 1, below.end, targets_.size(axis - 1), here);
        }
        descend(b, k, axis - 1, out, below.begin, below.end, here, scratch);
      }
    }
    first = last;
  }
}

/// The last pass, along axis 0 to its targets begin .. end, added to the result.
template <int d>
void Filter<d>::write_rows(std::size_t b, std::size_t k, const std::vector<const double*>& in, std::size_t rows,
                           std::size_t begin, std::size_t end, std::size_t offset) const {
  const AxisMatrix& matrix = matrix_[b][0];
  const std::size_t row = job_.bricks[b]->nodes[0];
  const std::size_t stride = stride_[d == 1 ? 0 : 1];
  for (std::size_t q = 0; q < row_matrix_.size(); ++q) {
    double* const rows_of_values = values_ + (q * job_.columns + k) * output_stride_ + offset;
    if (d > 1 && alone_) std::fill_n(rows_of_values, rows * stride, 0.0);
    for (std::size_t part = 0; part < row_matrix_[q].size(); ++part) {
      const double* entries = matrix.entries[row_matrix_[q][part]].data();
      const double* sums = in[d == 1 ? 0 : leaf_[job_.request.combinations[q][part].derivative]];
      for (const Group& group : matrix.groups) {
        const std::size_t from = std::max(begin, group.begin), to = std::min(end, group.begin + group.size);
        if (from >= to) continue;
        kernels().product({.rows = rows,
                           .depth = group.depth,
                           .width = to - from,
                           .b = sums + group.first,
                           .b_stride = row,
                           .d = entries + group.offset + (from - group.begin),
                           .d_stride = padded(group.size),
                           .c = rows_of_values + from,
                           .c_stride = stride});
      }
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
  double parts = 0;
  for (const auto& combination : job.request.combinations) parts += static_cast<double>(combination.size());
  double matrices = 0, largest = 0;
  for (const Brick<d>* brick : job.bricks) {
    double inner = 1, sums = 0;
    for (std::size_t l = 0; l < d; ++l) {
      const double nodes = static_cast<double>(brick->nodes[l]);
      const double within = std::min(sizes[l], on_lattice ? nodes + 2 * reach : sizes[l]);
      matrices +=
          (l == 0 ? 3 * parts : 2.0 * (job.request.highest[l] + 1)) * within * std::min(nodes, 2 * (2 * reach + 1));
      const std::size_t together = l == 1 ? most_rows : outer_group;
      if (l > 0)
        sums += static_cast<double>(job.request.derivatives.size() *
                                    std::min(together, static_cast<std::size_t>(sizes[l]))) *
                inner;
      inner *= nodes;
    }
    largest = std::max(largest, sums);
  }
  return 8 * (matrices + gaussdrift::base::resolve_threads(job.threads) * largest);
}

#define FGTD_INSTANTIATE(d)                                                                                       \
  template void apply_filter<d>(const FilterJob<d>&, const FilterTargets<d>&, std::size_t, std::size_t, double*); \
  template double filter_bytes<d>(const FilterJob<d>&, const std::array<double, d>&, bool);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
