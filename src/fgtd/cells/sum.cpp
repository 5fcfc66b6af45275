// Sorts points into cells and hands the sources around each cell of targets to the kernel `cells`; see fgtd/cells/sum.hpp.
#include "fgtd/cells/sum.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"
#include "fgtd/cells/cost.hpp"
#include "fgtd/cells/job.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t piece_targets = 512;  // one piece of work
constexpr std::size_t group_targets = 16;   // that share runs of sources, at most

/// The cells around a line of cells: each line of sources within reach, with the cells along it that are.
struct NearLine {
  std::size_t from, to;  // cells within reach of the latest group, from .. to - 1
  std::size_t end;       // of the line
  std::int64_t reach;    // along the line, in cells
};

/// The first place in [from, end) whose index along the line is `index` or more; near `from` as a rule.
template <int d>
std::size_t advance(const CellLattice<d>& cells, std::size_t from, std::size_t end, std::int64_t index) {
  std::size_t step = 1;
  while (from + step < end && cells.index[from + step][0] < index) {
    from += step;
    step *= 2;
  }
  end = std::min(end, from + step);
  while (from < end) {
    const std::size_t middle = from + (end - from) / 2;
    if (cells.index[middle][0] < index) {
      from = middle + 1;
    } else {
      end = middle;
    }
  }
  return from;
}

/// True if the line of cell `cell` comes before the line with the upper indices of `at`.
template <int d>
bool line_before(const BoxIndex<d>& cell, const BoxIndex<d>& at) {
  for (std::size_t l = d; l-- > 1;)
    if (cell[l] != at[l]) return cell[l] < at[l];
  return false;
}

/// Lists the lines of sources whose axes 1 .. d-1 are within reach of those of `at`.
template <int d>
void find_lines(const CellLattice<d>& cells, const BoxIndex<d>& at, std::vector<NearLine>& lines) {
  lines.clear();
  const std::int64_t span = cells.span;
  const std::size_t line_count = cells.first_line.size() - 1;
  // One search finds the lines that differ in axis 1 alone; the axes above are counted through.
  BoxIndex<d> from = at;
  for (std::size_t l = 1; l < d; ++l) from[l] -= span;
  while (true) {
    std::size_t low = 0, high = line_count;
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if (line_before<d>(cells.index[cells.first_line[middle]], from)) {
        low = middle + 1;
      } else {
        high = middle;
      }
    }
    for (; low < line_count; ++low) {
      const BoxIndex<d>& line = cells.index[cells.first_line[low]];
      bool near = true;
      for (std::size_t l = 2; l < d; ++l) near = near && line[l] == from[l];
      if constexpr (d > 1) near = near && line[1] <= at[1] + span;
      if (!near) break;
      // Points of cells that are i apart are more than i - 1 sides apart.
      std::int64_t squared = 0;
      for (std::size_t l = 1; l < d; ++l) {
        const std::int64_t apart = std::max<std::int64_t>(0, std::abs(line[l] - at[l]) - 1);
        squared += apart * apart;
      }
      if (squared > span * span) continue;
      std::int64_t reach = 1;
      while (reach < span && reach * reach + squared <= span * span) ++reach;
      lines.push_back({cells.first_line[low], cells.first_line[low], cells.first_line[low + 1], reach});
    }
    std::size_t l = 2;
    for (; l < d; ++l) {
      if (++from[l] <= at[l] + span) break;
      from[l] = at[l] - span;
    }
    if (l >= d) return;
  }
}

/// The number of targets from `begin` on that form a group; their cells are given. A group stays in one line. While its
/// vector of `lanes` is not full it takes the next target, unless that widens the sources seen by all of them by more
/// than it would see alone. Further full vectors are added if they hardly widen them.
template <int d>
std::size_t count_together(const std::vector<BoxIndex<d>>& index, std::size_t begin, std::size_t end, int span,
                           std::size_t lanes) {
  const BoxIndex<d>& first = index[begin];
  const std::int64_t alone = 2 * span + 1;
  end = std::min(end, begin + group_targets);
  std::size_t next = begin + 1;
  for (; next < end; ++next) {
    const BoxIndex<d>& at = index[next];
    for (std::size_t l = 1; l < d; ++l)
      if (at[l] != first[l]) return next - begin;
    const bool vector_is_full = (next - begin) % lanes == 0;
    if (vector_is_full ? 8 * (at[0] - first[0]) > alone : at[0] - index[next - 1][0] > alone) break;
  }
  return next - begin;
}

template <int d>
std::vector<BoxIndex<d>> cell_indices(const CellLattice<d>& cells, const double* points, std::size_t count,
                                      std::size_t point_step, std::size_t axis_step) {
  std::vector<BoxIndex<d>> index(count);
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t i = 0; i < count; ++i) index[i][l] = cells.index_at(l, points[i * point_step + l * axis_step]);
  return index;
}

/// Sorts the indices; `order[new place] = old place`. Reads out of order have a loop of their own, so that they
/// overlap.
template <int d>
std::vector<std::size_t> sort_indices(std::vector<BoxIndex<d>>& index) {
  std::vector<std::size_t> order = sorted_places<d>(index);
  std::vector<BoxIndex<d>> sorted(index.size());
  for (std::size_t j = 0; j < order.size(); ++j) sorted[j] = index[order[j]];
  index.swap(sorted);
  return order;
}

/// Calls open(j, axis) wherever the sorted indices change, with the last axis that does; for the first with d - 1.
template <int d, class Open>
void for_each_change(const std::vector<BoxIndex<d>>& index, const Open& open) {
  for (std::size_t j = 0; j < index.size(); ++j) {
    if (j == 0) {
      open(j, std::size_t{d - 1});
      continue;
    }
    const BoxIndex<d>&now = index[j], &before = index[j - 1];
    for (std::size_t l = d; l-- > 0;)
      if (now[l] != before[l]) {
        open(j, l);
        break;
      }
  }
}

/// Targets of a piece in groups, and the runs of sources within reach of each group.
struct Surroundings {
  std::vector<CellsGroup> groups;
  std::vector<std::size_t> runs;  // the first source of each and the end
};

/// Of the sorted targets begin .. end, whose cells are given.
template <int d>
Surroundings find_surroundings(const CellLattice<d>& cells, const std::vector<BoxIndex<d>>& index, std::size_t begin,
                               std::size_t end, std::size_t lanes) {
  Surroundings found;
  std::vector<std::size_t>& runs = found.runs;
  std::vector<NearLine> lines;
  for (std::size_t i = begin; i < end;) {
    const BoxIndex<d>& at = index[i];
    if (i == begin || line_before<d>(index[i - 1], at)) find_lines<d>(cells, at, lines);
    const std::size_t together = count_together<d>(index, i, end, cells.span, lanes);
    const std::int64_t last = index[i + together - 1][0];
    const std::size_t first_run = runs.size() / 2;
    for (NearLine& line : lines) {
      line.from = advance<d>(cells, line.from, line.end, at[0] - line.reach);
      line.to = advance<d>(cells, std::max(line.from, line.to), line.end, last + line.reach + 1);
      if (line.from == line.to) continue;
      const std::size_t first_source = cells.first[line.from], end_source = cells.first[line.to];
      if (runs.size() / 2 > first_run && runs.back() == first_source) {
        runs.back() = end_source;
      } else {
        runs.insert(runs.end(), {first_source, end_source});
      }
    }
    found.groups.push_back({i - begin, together, first_run, runs.size() / 2});
    i += together;
  }
  return found;
}

/// Sorts `position` ([d][count]) into cells.
template <int d>
std::vector<double> sort_into_cells(CellLattice<d>& cells, const Buffer<double>& position, std::size_t count,
                                    std::vector<std::size_t>& order) {
  for (std::size_t l = 0; l < d; ++l) {
    const double* x = position.data() + l * count;
    const auto [low, high] = std::minmax_element(x, x + count);
    cells.low[l] = *low;
    cells.last[l] = std::int64_t{1} << 40;  // not yet a bound
    cells.last[l] = cells.index_at(l, *high);
  }
  std::vector<BoxIndex<d>> index = cell_indices<d>(cells, position.data(), count, 1, count);
  order = sort_indices<d>(index);
  std::vector<double> sorted(d * count);
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t j = 0; j < count; ++j) sorted[l * count + j] = position[l * count + order[j]];
  for_each_change<d>(index, [&](std::size_t j, std::size_t axis) {
    if (axis > 0 || j == 0) cells.first_line.push_back(cells.index.size());
    cells.first.push_back(j);
    cells.index.push_back(index[j]);
  });
  cells.first_line.push_back(cells.index.size());
  cells.first.push_back(count);
  return sorted;
}

}  // namespace

template <int d>
std::int64_t CellLattice<d>::index_at(std::size_t axis, double x) const {
  const int before = span + 1;
  const double cell = (x - low[axis]) * (1 / side) + before;  // rounded down by the conversion, as it is not negative
  return static_cast<std::int64_t>(std::clamp(cell, 0.0, static_cast<double>(last[axis]) + 2 * before)) - before;
}

template <int d>
CellsSum<d>::CellsSum(const CellsPlan& plan, double sigma, Buffer<double> position, std::size_t count, int threads)
    : plan_(plan), sigma_(sigma), threads_(threads), count_(count) {
  cells_.side = plan.side;
  cells_.span = plan.span;
  position_ = sort_into_cells<d>(cells_, position, count, order_);
}

template <int d>
void CellsSum<d>::set_weights(const double* weights, std::size_t columns) {
  columns_ = columns;
  weights_.resize(columns * count_);
  for (std::size_t k = 0; k < columns; ++k)
    for (std::size_t j = 0; j < count_; ++j) weights_[k * count_ + j] = weights[k * count_ + order_[j]];
}

template <int d>
void CellsSum<d>::evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const {
  const std::size_t outputs = request.combinations.size() * columns_;
  if (outputs == 0 || count == 0) return;
  const FlatTerms<d> terms(request);
  const RecurrenceTable recurrence(max_derivative_order + 1);

  std::vector<BoxIndex<d>> index = cell_indices<d>(cells_, targets, count, d, 1);
  const std::vector<std::size_t> order = sort_indices<d>(index);
  const Kernels& kernel = kernels();
  constexpr std::size_t stride = piece_targets + target_padding;

  const double sources = static_cast<double>(count_), occupied = static_cast<double>(cells_.index.size());
  const double near = std::min(sources, sources / occupied * std::pow(2 * cells_.span + 1, d));  // of one target
  const double seconds = static_cast<double>(count) *
                         (cost::cells_target_sort + static_cast<double>(outputs) * near * cost::cells_pair[d - 1]);
  const gaussdrift::base::Pieces pieces((count + piece_targets - 1) / piece_targets, seconds);
  gaussdrift::base::parallel_for(pieces, threads_, [&](std::size_t piece) {
    const std::size_t begin = piece * piece_targets, end = std::min(count, begin + piece_targets);
    std::array<double, d * stride> target{};
    for (std::size_t i = begin; i < end; ++i)
      for (std::size_t l = 0; l < d; ++l) target[l * stride + i - begin] = targets[order[i] * d + l];

    const Surroundings near_sources = find_surroundings<d>(cells_, index, begin, end, kernel.lanes);
    std::vector<double> out(outputs * stride);
    kernel.cells({.dimension = d,
                  .degree = plan_.degree,
                  .sigma = sigma_,
                  .root_sigma = std::sqrt(sigma_),
                  .squared_reach = plan_.reach * plan_.reach,
                  .position = position_.data(),
                  .weights = weights_.data(),
                  .stride = count_,
                  .columns = columns_,
                  .combinations = request.combinations.size(),
                  .first_term = terms.first.data(),
                  .order = terms.order.data(),
                  .coefficient = terms.coefficient.data(),
                  .highest = request.highest.data(),
                  .recurrence = recurrence.view(),
                  .groups = near_sources.groups.size(),
                  .group = near_sources.groups.data(),
                  .run = near_sources.runs.data(),
                  .target = target.data(),
                  .out = out.data(),
                  .target_stride = stride});
    for (std::size_t output = 0; output < outputs; ++output)
      for (std::size_t i = begin; i < end; ++i) values[output * count + order[i]] = out[output * stride + i - begin];
  });
}

template <int d>
double CellsSum<d>::plan_bytes(std::size_t columns) const {
  const double cells =
      static_cast<double>(cells_.index.capacity()) * sizeof(BoxIndex<d>) +
      static_cast<double>(cells_.first.capacity() + cells_.first_line.capacity()) * sizeof(std::size_t);
  return 8.0 * static_cast<double>(count_) * static_cast<double>(d + columns) + 8.0 * static_cast<double>(count_) +
         cells;
}

/// Indices, places and keys of the sort; groups, runs and results of a piece.
template <int d>
double CellsSum<d>::point_bytes(const Request<d>& request, std::size_t count) const {
  const double threads = gaussdrift::base::resolve_threads(threads_);
  const double outputs = static_cast<double>(request.combinations.size() * columns_);
  const double lines = std::min(std::pow(2.0 * cells_.span + 1, d - 1), static_cast<double>(cells_.first_line.size()));
  const double piece = static_cast<double>(piece_targets) * (2 * sizeof(CellsGroup) + 8 * (d + outputs) + 32 * lines);
  return static_cast<double>(count) * (2 * 8.0 * d + 4 * 8.0) + threads * piece;
}

template <int d>
void CellsSum<d>::count(Choice& choice) const {
  const std::size_t occupied = cells_.index.size();
  if (auto* const cells = std::get_if<Cells>(&choice.parameters)) cells->occupied = occupied;
  if (auto* const cells = std::get_if<OuterProduct>(&choice.parameters)) cells->occupied = occupied;
}

#define FGTD_INSTANTIATE(d)       \
  template struct CellLattice<d>; \
  template class CellsSum<d>;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
