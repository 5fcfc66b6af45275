#include "fgtd/chebyshev/sum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "fgtd/chebyshev/cost.hpp"
#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/chebyshev/matrices.hpp"
#include "fgtd/chebyshev/translation.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {

namespace {

constexpr std::size_t moments_points = 1 << 14;      // of one piece of work
constexpr std::size_t interpolate_points = 1 << 12;  // of one piece of work
constexpr std::size_t interpolate_run = 256;         // targets of one box handed to the kernel at a time
constexpr std::size_t target_block = 1 << 22;        // targets sorted at a time
constexpr std::size_t coefficient_budget = 1 << 19;  // numbers of target boxes that exist at a time

template <int d>
std::array<int, d> axes_upwards() {
  std::array<int, d> axis;
  for (int l = 0; l < d; ++l) axis[static_cast<std::size_t>(l)] = l;
  return axis;
}

template <int d>
std::array<int, d> axes_downwards() {
  std::array<int, d> axis;
  for (int l = 0; l < d; ++l) axis[static_cast<std::size_t>(l)] = d - 1 - l;
  return axis;
}

/// Lowest and highest coordinates.
template <int d>
struct BoundingBox {
  std::array<double, d> low, high;

  void include(const double* point) {
    for (std::size_t l = 0; l < d; ++l) {
      low[l] = std::min(low[l], point[l]);
      high[l] = std::max(high[l], point[l]);
    }
  }
};

/// The same for points [count][d], count > 0. Several points are done side by side, so that no comparison waits for the
/// one before.
template <int d>
BoundingBox<d> bounding_box(const double* points, std::size_t count, int threads) {
  constexpr std::size_t together = 4, piece_points = 1 << 15;
  const std::size_t pieces = (count + piece_points - 1) / piece_points;
  std::vector<BoundingBox<d>> part(pieces);
  gaussdrift::base::parallel_for({pieces, 0.5e-9 * static_cast<double>(count * d)}, threads, [&](std::size_t piece) {
    const double* from = points + piece * piece_points * d;
    const std::size_t size = std::min(piece_points, count - piece * piece_points);
    double low[together * d], high[together * d];
    for (std::size_t i = 0; i < together * d; ++i) low[i] = high[i] = from[i % d];
    std::size_t j = 0;
    for (; j + together <= size; j += together)
      for (std::size_t i = 0; i < together * d; ++i) {
        const double x = from[j * d + i];
        low[i] = x < low[i] ? x : low[i];
        high[i] = x > high[i] ? x : high[i];
      }
    BoundingBox<d>& box = part[piece];
    std::copy_n(low, d, box.low.begin());
    std::copy_n(high, d, box.high.begin());
    for (std::size_t k = 1; k < together; ++k) {
      box.include(low + k * d);
      box.include(high + k * d);
    }
    for (; j < size; ++j) box.include(from + j * d);
  });
  for (const BoundingBox<d>& box : part) {
    part[0].include(box.low.data());
    part[0].include(box.high.data());
  }
  return part[0];
}

/// Numbers of target boxes that are computed at a time.
std::size_t boxes_at_a_time(std::size_t numbers_of_one) {
  return std::max<std::size_t>(1, coefficient_budget / std::max<std::size_t>(1, numbers_of_one));
}

}  // namespace

template <int d>
ChebyshevSum<d>::ChebyshevSum(const ChebyshevPlan<d>& plan, double sigma, Buffer<double> position, int threads)
    : plan_(plan), sigma_(sigma), threads_(threads), box_numbers_(to_power(static_cast<std::size_t>(plan.nodes), d)) {
  const int p = plan.nodes;
  for (int i = 0; i < p; ++i) {
    const double angle = std::numbers::pi * (i + 0.5) / p;
    node_.push_back(std::cos(angle));
    scale_.push_back((i % 2 == 0 ? 1 : -1) * std::sin(angle) * std::ldexp(1.0, p - 1) / p);  // 1 / T_P'(z_i) 2^(P-1)
  }
  const BoxRange<d> range = source_range();
  if (plan.few_boxes) {
    position_ = std::move(position);
    sources_.box = range.boxes();
  } else {
    const std::size_t count = position.size() / d;
    sources_ =
        sort_points<d>(plan.lattice, {position.data(), count, 1, count}, range.low, range.high, range.axis, threads);
  }
  tree_ = make_tree<d>(sources_.box, range.axis);
}

template <int d>
BoxRange<d> ChebyshevSum<d>::source_range() const {
  BoxRange<d> range{{}, plan_.lattice.boxes, axes_upwards<d>()};
  for (std::int64_t& i : range.high) --i;
  return range;
}

template <int d>
std::int64_t ChebyshevSum<d>::neighbours(std::size_t l) const {
  const double scaled_side = plan_.lattice.side[l] * std::sqrt(sigma_);
  return static_cast<std::int64_t>(std::floor(plan_.reach / scaled_side)) + 1;
}

template <int d>
void ChebyshevSum<d>::set_weights(const double* weights, std::size_t columns) {
  columns_ = columns;
  if (plan_.few_boxes) {
    const std::size_t count = position_.size() / d;
    block_moments<d>(plan_.lattice, source_range(), plan_.nodes, {position_.data(), count, 1, count}, weights, columns,
                     threads_, moments_);
  } else {
    sum_moments(weights);
  }
}

/// Pieces of sorted sources. If two pieces share a box, each sums its own part, and the parts are added in the order of
/// the pieces.
template <int d>
void ChebyshevSum<d>::sum_moments(const double* weights) {
  const std::size_t columns = columns_, numbers = columns * box_numbers_, count = sources_.order.size();
  moments_.assign(sources_.box.size() * numbers + chain_padding, 0.0);
  if (columns == 0) return;
  const std::size_t piece_points = std::max(moments_points, 4 * box_numbers_);
  const std::size_t pieces = (count + piece_points - 1) / piece_points;
  std::vector<double> shared(2 * pieces * numbers + chain_padding, 0.0);
  const auto first_box = [&](std::size_t j) {
    return static_cast<std::size_t>(std::upper_bound(sources_.first.begin(), sources_.first.end(), j) -
                                    sources_.first.begin()) -
           1;
  };
  const double a_source = static_cast<double>(d * node_.size()) * cost::chebyshev_basis +
                          static_cast<double>(numbers) * cost::chebyshev_step;
  gaussdrift::base::parallel_for({pieces, static_cast<double>(count) * a_source}, threads_, [&](std::size_t piece) {
    Buffer<double> scratch(moments_scratch(d, plan_.nodes, columns), 0.0), weight(columns * moments_chunk);
    const std::size_t begin = piece * piece_points, end = std::min(count, begin + piece_points);
    std::size_t box = first_box(begin);
    for (std::size_t j = begin; j < end; ++box) {
      const std::size_t box_end = std::min(end, sources_.first[box + 1]);
      double* moments = moments_.data() + box * numbers;
      if (sources_.first[box + 1] > end) moments = shared.data() + (2 * piece + 1) * numbers;
      if (sources_.first[box] < begin) moments = shared.data() + 2 * piece * numbers;
      while (j < box_end) {
        const std::size_t size = std::min(moments_chunk, box_end - j);
        for (std::size_t k = 0; k < columns; ++k)
          for (std::size_t i = 0; i < size; ++i)
            weight[k * moments_chunk + i] = weights[k * count + sources_.order[j + i]];
        kernels().moments({.dimension = d,
                           .basis = {plan_.nodes, node_.data(), scale_.data()},
                           .count = size,
                           .local = sources_.local.data() + j * d,
                           .local_stride = d,
                           .columns = columns,
                           .weights = weight.data(),
                           .weight_stride = moments_chunk,
                           .moments = moments,
                           .scratch = scratch.data()});
        j += size;
      }
    }
  });
  for (std::size_t piece = 0; piece < pieces; ++piece) {
    const std::size_t begin = piece * piece_points, end = std::min(count, begin + piece_points);
    const auto add = [&](std::size_t box, std::size_t slot) {
      for (std::size_t i = 0; i < numbers; ++i) moments_[box * numbers + i] += shared[slot * numbers + i];
    };
    const std::size_t first = first_box(begin), last = first_box(end - 1);
    if (sources_.first[first] < begin) add(first, 2 * piece);
    if (sources_.first[last + 1] > end && sources_.first[last] >= begin) add(last, 2 * piece + 1);
  }
}

template <int d>
std::array<AxisMatrices, d> ChebyshevSum<d>::matrices_between_boxes(const Request<d>& request) const {
  std::array<AxisMatrices, d> matrices;
  for (std::size_t l = 0; l < d; ++l)
    matrices[l] =
        box_matrices(node_, plan_.lattice.side[l] * std::sqrt(sigma_), neighbours(l), request.highest[l], l == 0);
  return matrices;
}

template <int d>
void ChebyshevSum<d>::evaluate(const Request<d>& request, const double* targets, std::size_t count,
                               double* values) const {
  if (request.combinations.size() * columns_ == 0 || count == 0) return;
  const BoundingBox<d> around = bounding_box<d>(targets, count, threads_);
  // boxes that hold targets, as far as sources are in their reach
  BoxRange<d> range{{}, {}, axes_downwards<d>()};
  BoxIndex<d> least, most;
  for (std::size_t l = 0; l < d; ++l) {
    least[l] = -neighbours(l);
    most[l] = plan_.lattice.boxes[l] - 1 + neighbours(l);
    const auto index = [&](double y) {
      const double box = box_of(y, plan_.lattice.origin[l], plan_.lattice.side[l]);
      return static_cast<std::int64_t>(std::clamp(box, static_cast<double>(least[l]), static_cast<double>(most[l])));
    };
    range.low[l] = index(around.low[l]);
    range.high[l] = index(around.high[l]);
  }
  if (are_few(range.count(), static_cast<double>(box_numbers_), static_cast<double>(count))) {
    evaluate_few(request, range, least, most, targets, count, values);
    return;
  }
  // one box more, because rounding of the quotient may have missed it
  for (std::size_t l = 0; l < d; ++l) {
    range.low[l] = std::max(least[l], range.low[l] - 1);
    range.high[l] = std::min(most[l], range.high[l] + 1);
  }
  for (std::size_t begin = 0; begin < count; begin += target_block)
    evaluate_block(request, range, targets + begin * d, std::min(target_block, count - begin), values + begin, count);
}

/// Seconds of one axis for so many results: each is a sum over the nodes of the boxes in reach.
template <int d>
double ChebyshevSum<d>::sum_over_boxes(std::size_t results) const {
  const auto boxes = static_cast<double>(std::min(plan_.lattice.boxes[0], 2 * neighbours(0) + 1));
  return static_cast<double>(results * node_.size()) * boxes * cost::chebyshev_product;
}

template <int d>
void ChebyshevSum<d>::evaluate_few(const Request<d>& request, const BoxRange<d>& range, const BoxIndex<d>& least,
                                   const BoxIndex<d>& most, const double* targets, std::size_t count,
                                   double* values) const {
  const std::size_t outputs = request.combinations.size() * columns_;
  const std::vector<BoxIndex<d>> boxes = range.boxes();
  Buffer<double> coefficients(boxes.size() * outputs * box_numbers_ + chain_padding);
  std::fill(coefficients.end() - static_cast<std::ptrdiff_t>(chain_padding), coefficients.end(), 0.0);
  translate(request, matrices_between_boxes(request), make_tree<d>(boxes, range.axis), 0, boxes.size(),
            coefficients.data());
  block_values<d>(plan_.lattice, range, least, most, plan_.nodes, {targets, 1, d, count}, outputs, coefficients.data(),
                  values, count, threads_);
}

template <int d>
void ChebyshevSum<d>::translate(const Request<d>& request, const std::array<AxisMatrices, d>& matrices,
                                const std::array<BoxLevel, d>& tree, std::size_t begin, std::size_t end,
                                double* coefficients) const {
  const std::size_t numbers = request.combinations.size() * columns_ * box_numbers_;
  std::fill_n(coefficients, (end - begin) * numbers, 0.0);
  // nodes of every level that lead to the boxes begin .. end
  std::array<std::size_t, d> from, to;
  from[d - 1] = begin;
  to[d - 1] = end;
  for (std::size_t j = d - 1; j-- > 0;) {
    const auto& first = tree[j].first;
    from[j] = static_cast<std::size_t>(std::upper_bound(first.begin(), first.end(), from[j + 1]) - first.begin()) - 1;
    to[j] = static_cast<std::size_t>(std::lower_bound(first.begin(), first.end(), to[j + 1]) - first.begin());
  }
  const std::size_t slabs = to[0] - from[0], pieces = std::min<std::size_t>(slabs, 64);
  const double a_box = static_cast<double>(request.derivatives.size() * columns_) *
                       (cost::chebyshev_contraction + sum_over_boxes(box_numbers_));
  gaussdrift::base::parallel_for({pieces, static_cast<double>(end - begin) * a_box}, threads_, [&](std::size_t piece) {
    Translation translation(*this, request, matrices);
    const std::size_t p = node_.size();
    for (std::size_t k = 0; k < columns_; ++k) {
      translation.use_column(k);
      const auto descend = [&](const auto& self, std::size_t j, std::size_t node, std::size_t above,
                               const std::vector<std::size_t>& derivatives) -> void {
        const std::size_t axis = d - 1 - j;
        translation.contract(axis, matrices[axis].box(tree[j].index[node]), above, derivatives,
                             [&](const std::vector<std::size_t>& subset) {
                               if (axis > 0) {
                                 const std::size_t first = std::max(tree[j].first[node], from[j + 1]);
                                 const std::size_t last = std::min(tree[j].first[node + 1], to[j + 1]);
                                 for (std::size_t child = first; child < last; ++child)
                                   self(self, j + 1, child, above * p, subset);
                                 return;
                               }
                               const double* result = translation.result();
                               for (std::size_t q = 0; q < request.combinations.size(); ++q)
                                 for (const auto& part : request.combinations[q]) {
                                   if (std::find(subset.begin(), subset.end(), part.derivative) == subset.end())
                                     continue;
                                   double* into =
                                       coefficients + (node - begin) * numbers + (q * columns_ + k) * box_numbers_;
                                   for (std::size_t i = 0; i < box_numbers_; ++i) into[i] += part.factor * result[i];
                                 }
                             });
      };
      for (std::size_t slab = from[0] + slabs * piece / pieces; slab < from[0] + slabs * (piece + 1) / pieces; ++slab)
        descend(descend, 0, slab, 1, translation.all_derivatives());
    }
  });
}

/// Sorts the targets, computes coefficients for boxes of targets, as many as the budget allows at a time, and
/// interpolates.
template <int d>
void ChebyshevSum<d>::evaluate_block(const Request<d>& request, const BoxRange<d>& range, const double* targets,
                                     std::size_t count, double* values, std::size_t stride) const {
  const std::size_t outputs = request.combinations.size() * columns_;
  const std::array<AxisMatrices, d> matrices = matrices_between_boxes(request);
  const SortedPoints<d> sorted =
      sort_points<d>(plan_.lattice, {targets, 1, d, count}, range.low, range.high, range.axis, threads_);
  for (const std::size_t i : sorted.outside)
    for (std::size_t q = 0; q < outputs; ++q) values[q * stride + i] = 0;

  const std::array<BoxLevel, d> tree = make_tree<d>(sorted.box, range.axis);
  const std::size_t numbers = outputs * box_numbers_, at_a_time = boxes_at_a_time(numbers);
  std::vector<double> coefficients;
  for (std::size_t begin = 0; begin < sorted.box.size(); begin += at_a_time) {
    const std::size_t end = std::min(sorted.box.size(), begin + at_a_time);
    coefficients.resize((end - begin) * numbers);
    translate(request, matrices, tree, begin, end, coefficients.data());

    const std::size_t first_point = sorted.first[begin], points = sorted.first[end] - first_point;
    const double a_target = static_cast<double>(outputs) *
                            (cost::chebyshev_value + static_cast<double>(box_numbers_) * cost::chebyshev_step);
    gaussdrift::base::parallel_for(
        {(points + interpolate_points - 1) / interpolate_points, static_cast<double>(points) * a_target}, threads_,
        [&](std::size_t piece) {
          Buffer<double> scratch(interpolate_scratch(d, plan_.nodes), 0.0), found(outputs * interpolate_run);
          std::size_t j = first_point + piece * interpolate_points;
          const std::size_t last = std::min(first_point + points, j + interpolate_points);
          std::size_t box = static_cast<std::size_t>(std::upper_bound(sorted.first.begin(), sorted.first.end(), j) -
                                                     sorted.first.begin()) -
                            1;
          while (j < last) {
            while (sorted.first[box + 1] <= j) ++box;
            const std::size_t size = std::min({interpolate_run, last - j, sorted.first[box + 1] - j});
            kernels().interpolate({.dimension = d,
                                   .basis = {plan_.nodes, node_.data(), scale_.data()},
                                   .count = size,
                                   .local = sorted.local.data() + j * d,
                                   .local_stride = d,
                                   .outputs = outputs,
                                   .coefficients = coefficients.data() + (box - begin) * numbers,
                                   .values = found.data(),
                                   .value_stride = interpolate_run,
                                   .scratch = scratch.data()});
            for (std::size_t q = 0; q < outputs; ++q)
              for (std::size_t i = 0; i < size; ++i)
                values[q * stride + sorted.order[j + i]] = found[q * interpolate_run + i];
            j += size;
          }
        });
  }
}

template <int d>
void ChebyshevSum<d>::evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const {
  const std::size_t count = grid.size(), outputs = request.combinations.size() * columns_;
  if (outputs == 0 || count == 0) return;
  std::array<AxisMatrices, d> matrices;
  std::array<std::size_t, d> stride;  // in the result
  for (std::size_t l = 0; l < d; ++l) {
    matrices[l] = grid_matrices(grid.axes[l], node_, plan_.lattice.origin[l], plan_.lattice.side[l],
                                plan_.lattice.boxes[l], std::sqrt(sigma_), plan_.reach, request.highest[l], l == 0);
    stride[l] = l == 0 ? 1 : stride[l - 1] * grid.axes[l - 1].size();
  }
  const std::size_t slabs = matrices[d - 1].group.size();
  // Every node of the last axis meets the moments of the boxes near it, every node of the grid what is left of them.
  const double near =
      std::min(1.0, static_cast<double>(2 * neighbours(d - 1) + 1) / static_cast<double>(plan_.lattice.boxes[d - 1])) *
      static_cast<double>(moments_.size() * grid.axes[d - 1].size()) * cost::chebyshev_product;
  const double seconds =
      static_cast<double>(request.derivatives.size()) *
      (near + static_cast<double>(columns_) * (sum_over_boxes(count) + static_cast<double>(count) * cost::grid_value));
  gaussdrift::base::parallel_for({slabs, seconds}, threads_, [&](std::size_t slab) {
    // the part of the result that is written here: whole slices of the last axis
    const AxisMatrices::Group& nodes = matrices[d - 1].group[slab];
    for (std::size_t q = 0; q < outputs; ++q)
      std::fill_n(values + q * count + nodes.first_row * stride[d - 1], nodes.rows * stride[d - 1], 0.0);
    Translation translation(*this, request, matrices);
    for (std::size_t k = 0; k < columns_; ++k) {
      translation.use_column(k);
      std::array<const AxisMatrices::Group*, d> chosen{};
      const auto descend = [&](const auto& self, std::size_t axis, const AxisMatrices::Group& group, std::size_t above,
                               const std::vector<std::size_t>& derivatives) -> void {
        chosen[axis] = &group;
        translation.contract(axis, group, above, derivatives, [&](const std::vector<std::size_t>& subset) {
          if (axis > 0) {
            for (const auto& next : matrices[axis - 1].group) self(self, axis - 1, next, above * group.rows, subset);
            return;
          }
          for (std::size_t q = 0; q < request.combinations.size(); ++q)
            for (const auto& part : request.combinations[q]) {
              if (std::find(subset.begin(), subset.end(), part.derivative) == subset.end()) continue;
              const double* result = translation.result();
              for (std::size_t row = 0; row < above; ++row, result += group.rows) {
                std::size_t place = group.first_row, rest = row;  // rows of the axes above, the last axis slowest
                for (std::size_t l = 1; l < d; ++l) {
                  place += (chosen[l]->first_row + rest % chosen[l]->rows) * stride[l];
                  rest /= chosen[l]->rows;
                }
                double* into = values + (q * columns_ + k) * count + place;
                for (std::size_t i = 0; i < group.rows; ++i) into[i] += part.factor * result[i];
              }
            }
        });
      };
      descend(descend, d - 1, nodes, 1, translation.all_derivatives());
    }
  });
}

template <int d>
double ChebyshevSum<d>::plan_bytes(std::size_t columns) const {
  const double points = static_cast<double>(sources_.order.size()), boxes = static_cast<double>(sources_.box.size());
  const double numbers = 8.0 * static_cast<double>(columns) * static_cast<double>(box_numbers_);
  if (plan_.few_boxes) {
    const double sources = static_cast<double>(position_.size() / d);
    return sources * 8.0 * d + boxes * (numbers + 24.0 * d + 8) +
           block_moments_bytes(d, plan_.nodes, boxes, sources, static_cast<double>(columns), threads_);
  }
  const double pieces = std::ceil(points / static_cast<double>(std::max(moments_points, 4 * box_numbers_)));
  return points * (8.0 * d + 4) + boxes * (numbers + 24.0 * d + 8) + 2 * pieces * numbers;
}

template <int d>
double ChebyshevSum<d>::point_bytes(const Request<d>& request, std::size_t count) const {
  const double outputs = static_cast<double>(request.combinations.size() * columns_);
  const double numbers = outputs * static_cast<double>(box_numbers_);
  const double points = static_cast<double>(std::min(count, target_block));
  const double few = most_few_boxes(static_cast<double>(box_numbers_), static_cast<double>(count));
  double bytes =
      std::max(sorting_bytes(d, points) + 8 * std::min(points * numbers, std::max(numbers, 1.0 * coefficient_budget)),
               few * (8 * numbers + 48.0 * d) + block_values_bytes(d, plan_.nodes, few, outputs, threads_));
  double partial = 8 * static_cast<double>(sources_.box.size());  // of one thread
  for (std::size_t l = 0; l < d; ++l) {
    const double nodes = l == 0 ? 1 : static_cast<double>(tree_[l - 1].index.size());
    partial += 8 * nodes * (static_cast<double>(box_numbers_) + 3);
    bytes += 8 * static_cast<double>(2 * neighbours(l) + 1) * static_cast<double>(node_.size() * node_.size()) *
             (request.highest[l] + 2);
  }
  return bytes + partial * gaussdrift::base::resolve_threads(threads_);
}

template <int d>
double ChebyshevSum<d>::grid_bytes(const Request<d>& request, const TensorGrid& grid) const {
  const double p = static_cast<double>(node_.size());
  double bytes = 0, partial = 8 * static_cast<double>(sources_.box.size());  // of one thread
  for (std::size_t l = 0; l < d; ++l) {
    const auto groups = grid_groups(grid.axes[l], plan_.lattice.origin[l], plan_.lattice.side[l],
                                    plan_.lattice.boxes[l], plan_.reach / std::sqrt(sigma_), node_.size());
    bytes += 8 * group_numbers(groups, node_.size()) * (request.highest[l] + 2) +
             static_cast<double>(sizeof(AxisMatrices::Group) * 2 * groups.size());
    const double nodes = l == 0 ? 1 : static_cast<double>(tree_[l - 1].index.size());
    partial += 8 * nodes * (std::pow(grid_group, d - static_cast<double>(l)) * std::pow(p, static_cast<double>(l)) + 3);
  }
  return bytes + partial * gaussdrift::base::resolve_threads(threads_);
}

template class ChebyshevSum<1>;
template class ChebyshevSum<2>;
template class ChebyshevSum<3>;
template class ChebyshevSum<4>;

}  // namespace fgtd::detail
