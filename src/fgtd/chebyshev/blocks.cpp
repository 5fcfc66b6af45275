#include "fgtd/chebyshev/blocks.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"
#include "fgtd/chebyshev/cost.hpp"
#include "fgtd/chebyshev/jobs.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

constexpr double most_boxes = 1024;
constexpr double most_numbers = 1 << 17;       // of all boxes
constexpr std::size_t piece_points = 1 << 15;  // of one piece of parallel work, at least
constexpr std::size_t most_pieces = 16;
constexpr std::size_t run_points = 256;  // handed to interpolation at a time

std::size_t pieces_for(double all_numbers, std::size_t points) {
  const double fewest = std::max(static_cast<double>(piece_points), 2 * all_numbers);
  return std::clamp<std::size_t>(static_cast<std::size_t>(static_cast<double>(points) / fewest), 1, most_pieces);
}

/// Seconds at the points, with so many for each of the P^d numbers of a box.
double at_points(int d, std::size_t p, std::size_t points, double a_number) {
  return static_cast<double>(points) *
         (cost::chebyshev_block_sort + static_cast<double>(p) * d * cost::chebyshev_block_basis +
          static_cast<double>(to_power(p, d)) * a_number);
}

/// Seconds of transforming the numbers of so many boxes.
double transforms(int d, std::size_t p, std::size_t boxes) {
  return static_cast<double>(boxes * to_power(p, d) * p) * d * cost::chebyshev_product;
}

/// t_mk of the header as a matrix: [m][k], or [k][m].
std::vector<double> node_polynomials(int nodes, bool nodes_first) {
  const std::size_t p = static_cast<std::size_t>(nodes);
  std::vector<double> t(p * p + chain_padding, 0.0);
  for (std::size_t m = 0; m < p; ++m)
    for (std::size_t k = 0; k < p; ++k)
      t[nodes_first ? m * p + k : k * p + m] =
          (k == 0 ? 1.0 : 2.0) / nodes *
          std::cos(static_cast<double>(k) * std::numbers::pi * (static_cast<double>(m) + 0.5) / nodes);
  return t;
}

/// Multiplies every axis of box numbers by a P x P matrix: from polynomials to nodes or back.
class AxisTransform {
 public:
  AxisTransform(int d, int nodes, bool to_nodes)
      : dimension_(d),
        nodes_(static_cast<std::size_t>(nodes)),
        numbers_(to_power(nodes_, d)),
        left_(node_polynomials(nodes, to_nodes)),
        right_(node_polynomials(nodes, !to_nodes)) {}

  /// to[P^d] = from[P^d] transformed; both readable chain_padding numbers beyond. scratch: 2 (P^d + chain_padding).
  void operator()(const double* from, double* to, double* scratch) const {
    double* next[2] = {scratch, scratch + numbers_ + chain_padding};
    std::size_t width = 1;
    for (int l = 0; l < dimension_; ++l, width *= nodes_) {
      double* into = l + 1 == dimension_ ? to : next[l % 2];
      if (l == 0) {
        multiply(numbers_ / nodes_, nodes_, from, nodes_, right_.data(), nodes_, into, nodes_);
      } else {
        const std::size_t slice = nodes_ * width;
        for (std::size_t above = 0; above < numbers_; above += slice)
          multiply(nodes_, width, left_.data(), nodes_, from + above, width, into + above, width);
      }
      from = into;
    }
  }

 private:
  void multiply(std::size_t rows, std::size_t width, const double* b, std::size_t b_stride, const double* right,
                std::size_t d_stride, double* c, std::size_t c_stride) const {
    kernels().chain({.rows = rows,
                     .depth = nodes_,
                     .width = width,
                     .links = 1,
                     .b = &b,
                     .b_stride = b_stride,
                     .d = &right,
                     .d_stride = d_stride,
                     .c = c,
                     .c_stride = c_stride,
                     .add = false});
  }

  int dimension_;
  std::size_t nodes_, numbers_;
  std::vector<double> left_, right_;  // the matrix, and its transpose for the axis that stands on the left
};

/// A block of points sorted by box.
template <int d>
class Block {
 public:
  Block(const BoxLattice<d>& lattice, const BoxRange<d>& range, std::size_t columns, const BoxIndex<d>* least,
        const BoxIndex<d>* most)
      : boxes_(static_cast<std::size_t>(range.count())),
        first_(boxes_ + 2),
        points_(block_points(range.count())),
        order_(columns == 0 ? points_ : 0),
        key_(points_ + sort_padding),
        local_(record_numbers * (2 * points_ + sort_padding)),
        weight_(columns * points_) {
    double step = 1;
    for (std::size_t j = d; j-- > 0;) {
      const std::size_t l = static_cast<std::size_t>(range.axis[j]);
      job_.step[l] = step;
      step *= static_cast<double>(range.high[l] - range.low[l] + 1);
      job_.origin[l] = lattice.origin[l];
      job_.side[l] = lattice.side[l];
      job_.low[l] = static_cast<double>(range.low[l]);
      job_.high[l] = static_cast<double>(range.high[l]);
      job_.least[l] = least == nullptr ? -0x1p50 : static_cast<double>((*least)[l]);
      job_.most[l] = most == nullptr ? 0x1p50 : static_cast<double>((*most)[l]);
    }
    job_.dimension = d;
    job_.boxes = boxes_;
    job_.columns = columns;
    job_.weight_stride = points_;
  }

  void sort(const PointView& points, std::size_t begin, std::size_t count, const double* weights) {
    job_.first = first_.data();
    job_.order = job_.columns == 0 ? order_.data() : nullptr;
    job_.key = key_.data();
    job_.local = local_.data();
    job_.unsorted = local_.data() + record_numbers * points_;
    job_.weight = weight_.data();
    job_.count = count;
    job_.coordinate = points.data + begin * points.point_stride;
    job_.axis_stride = points.axis_stride;
    job_.point_stride = points.point_stride;
    job_.given_weights = weights == nullptr ? nullptr : weights + begin;
    job_.given_stride = points.count;
    kernels().sort_block(job_);
  }

  std::size_t points() const { return points_; }
  std::size_t first(std::size_t box) const { return first_[box]; }
  const double* local(std::size_t j) const { return local_.data() + record_numbers * j; }
  const double* weight(std::size_t j) const { return weight_.data() + j; }
  std::size_t order(std::size_t j) const { return order_[j]; }

 private:
  SortBlockJob job_{};
  std::size_t boxes_;
  std::vector<std::uint32_t> first_;
  std::size_t points_;  // of a block
  Buffer<std::uint32_t> order_, key_;
  Buffer<double> local_, weight_;
};

}  // namespace

template <int d>
std::vector<BoxIndex<d>> BoxRange<d>::boxes() const {
  std::vector<BoxIndex<d>> all;
  all.reserve(static_cast<std::size_t>(count()));
  BoxIndex<d> at = low;
  for (;;) {
    all.push_back(at);
    std::size_t j = d;
    while (j-- > 0) {
      const std::size_t l = static_cast<std::size_t>(axis[j]);
      if (++at[l] <= high[l]) break;
      at[l] = low[l];
      if (j == 0) return all;
    }
  }
}

double most_few_boxes(double box_numbers, double points) {
  return std::floor(std::min({most_boxes, most_numbers / box_numbers, points / 8}));
}

bool are_few(double boxes, double box_numbers, double points) { return boxes <= most_few_boxes(box_numbers, points); }

double box_of(double coordinate, double origin, double side) { return std::floor((coordinate - origin) * (1 / side)); }

template <int d>
void block_moments(const BoxLattice<d>& lattice, const BoxRange<d>& range, int nodes, const PointView& points,
                   const double* weights, std::size_t columns, int threads, Buffer<double>& moments) {
  const std::size_t p = static_cast<std::size_t>(nodes), box_numbers = to_power(p, d);
  const std::size_t boxes = static_cast<std::size_t>(range.count()), all = boxes * columns * box_numbers;
  moments.resize(all + chain_padding);
  std::fill(moments.end() - static_cast<std::ptrdiff_t>(chain_padding), moments.end(), 0.0);
  if (all == 0) return;
  const std::size_t pieces = pieces_for(static_cast<double>(all), points.count);
  Buffer<double> parts(pieces * all + chain_padding);
  struct Scratch {
    Block<d> block;
    Buffer<double> numbers;
  };
  const auto make_scratch = [&] {
    return Scratch{Block<d>(lattice, range, columns, nullptr, nullptr),
                   Buffer<double>(moments_scratch(d, nodes, columns), 0.0)};
  };
  gaussdrift::base::parallel_for(
      {pieces, at_points(d, p, points.count, static_cast<double>(columns) * cost::chebyshev_block_moment)}, threads,
      make_scratch, [&](Scratch& scratch, std::size_t piece) {
        double* sum = parts.data() + piece * all;
        std::fill_n(sum, all, 0.0);
        Block<d>& block = scratch.block;
        const std::size_t end = points.count * (piece + 1) / pieces;
        for (std::size_t begin = points.count * piece / pieces; begin < end; begin += block.points()) {
          block.sort(points, begin, std::min(block.points(), end - begin), weights);
          for (std::size_t box = 0; box < boxes; ++box)
            for (std::size_t j = block.first(box); j < block.first(box + 1); j += moments_chunk)
              kernels().moments({.dimension = d,
                                 .basis = {nodes, nullptr, nullptr},
                                 .count = std::min(moments_chunk, block.first(box + 1) - j),
                                 .local = block.local(j),
                                 .local_stride = record_numbers,
                                 .columns = columns,
                                 .weights = block.weight(j),
                                 .weight_stride = block.points(),
                                 .moments = sum + box * columns * box_numbers,
                                 .scratch = scratch.numbers.data()});
        }
      });
  const AxisTransform to_nodes(d, nodes, true);
  const std::size_t share = std::min<std::size_t>(boxes, 64);
  const double adding = static_cast<double>(pieces * all) * 0.5e-9;
  gaussdrift::base::parallel_for({share, transforms(d, p, boxes * columns) + adding}, threads, [&](std::size_t part) {
    std::vector<double> scratch(3 * (box_numbers + chain_padding));
    double* sum = scratch.data() + 2 * (box_numbers + chain_padding);
    for (std::size_t at = boxes * columns * part / share; at < boxes * columns * (part + 1) / share; ++at) {
      std::copy_n(parts.data() + at * box_numbers, box_numbers, sum);
      for (std::size_t piece = 1; piece < pieces; ++piece)
        for (std::size_t i = 0; i < box_numbers; ++i) sum[i] += parts[piece * all + at * box_numbers + i];
      to_nodes(sum, moments.data() + at * box_numbers, scratch.data());
    }
  });
}

template <int d>
void block_values(const BoxLattice<d>& lattice, const BoxRange<d>& range, const BoxIndex<d>& least,
                  const BoxIndex<d>& most, int nodes, const PointView& points, std::size_t outputs,
                  const double* at_nodes, double* values, std::size_t stride, int threads) {
  const std::size_t p = static_cast<std::size_t>(nodes), box_numbers = to_power(p, d);
  const std::size_t boxes = static_cast<std::size_t>(range.count());
  Buffer<double> coefficients(boxes * outputs * box_numbers + chain_padding);
  std::fill(coefficients.end() - static_cast<std::ptrdiff_t>(chain_padding), coefficients.end(), 0.0);
  const AxisTransform to_polynomials(d, nodes, false);
  const std::size_t share = std::min<std::size_t>(boxes, 64);
  gaussdrift::base::parallel_for({share, transforms(d, p, boxes * outputs)}, threads, [&](std::size_t part) {
    std::vector<double> scratch(2 * (box_numbers + chain_padding));
    for (std::size_t at = boxes * outputs * part / share; at < boxes * outputs * (part + 1) / share; ++at)
      to_polynomials(at_nodes + at * box_numbers, coefficients.data() + at * box_numbers, scratch.data());
  });

  const std::size_t blocks = (points.count + block_points(range.count()) - 1) / block_points(range.count());
  const std::size_t pieces = std::min<std::size_t>(blocks, 64);
  struct Scratch {
    Block<d> block;
    Buffer<double> numbers, found;
  };
  const auto make_scratch = [&] {
    return Scratch{Block<d>(lattice, range, 0, &least, &most), Buffer<double>(interpolate_scratch(d, nodes), 0.0),
                   Buffer<double>(outputs * run_points)};
  };
  gaussdrift::base::parallel_for(
      {pieces, at_points(d, p, points.count, static_cast<double>(outputs) * cost::chebyshev_block_value)}, threads,
      make_scratch, [&](Scratch& scratch, std::size_t piece) {
        Block<d>& block = scratch.block;
        double* found = scratch.found.data();
        const std::size_t end = points.count * (piece + 1) / pieces;
        for (std::size_t begin = points.count * piece / pieces; begin < end; begin += block.points()) {
          const std::size_t size = std::min(block.points(), end - begin);
          block.sort(points, begin, size, nullptr);
          for (std::size_t box = 0; box < boxes; ++box)
            for (std::size_t j = block.first(box); j < block.first(box + 1); j += run_points) {
              const std::size_t run = std::min(run_points, block.first(box + 1) - j);
              kernels().interpolate({.dimension = d,
                                     .basis = {nodes, nullptr, nullptr},
                                     .count = run,
                                     .local = block.local(j),
                                     .local_stride = record_numbers,
                                     .outputs = outputs,
                                     .coefficients = coefficients.data() + box * outputs * box_numbers,
                                     .values = found,
                                     .value_stride = run_points,
                                     .scratch = scratch.numbers.data()});
              for (std::size_t q = 0; q < outputs; ++q)
                for (std::size_t i = 0; i < run; ++i)
                  values[q * stride + begin + block.order(j + i)] = found[q * run_points + i];
            }
          for (std::size_t j = block.first(boxes); j < size; ++j)
            for (std::size_t q = 0; q < outputs; ++q) values[q * stride + begin + block.order(j)] = 0;
        }
      });
}

namespace {
double block_bytes(double boxes, double columns) {
  return static_cast<double>(block_points(boxes)) * (2 * 4 + 8.0 * (2 * record_numbers + columns)) + 4 * (boxes + 2) +
         1024;
}
}  // namespace

double block_moments_bytes(int d, int nodes, double boxes, double points, double columns, int threads) {
  const double numbers = std::pow(nodes, d), all = boxes * columns * numbers;
  const double pieces = static_cast<double>(pieces_for(all, static_cast<std::size_t>(points)));
  const double one = block_bytes(boxes, columns) +
                     8 * static_cast<double>(moments_scratch(d, nodes, static_cast<std::size_t>(columns))) +
                     24 * (numbers + chain_padding);
  return 8 * (pieces * all + chain_padding) + one * gaussdrift::base::resolve_threads(threads) + 32.0 * nodes * nodes;
}

double block_values_bytes(int d, int nodes, double boxes, double outputs, int threads) {
  const double numbers = std::pow(nodes, d);
  const double one = block_bytes(boxes, 0) + 8 * static_cast<double>(interpolate_scratch(d, nodes)) +
                     8 * outputs * static_cast<double>(run_points) + 16 * (numbers + chain_padding);
  return 8 * (boxes * outputs * numbers + chain_padding) + one * gaussdrift::base::resolve_threads(threads) +
         32.0 * nodes * nodes;
}

#define FGTD_INSTANTIATE(d)                                                                                            \
  template struct BoxRange<d>;                                                                                         \
  template void block_moments<d>(const BoxLattice<d>&, const BoxRange<d>&, int, const PointView&, const double*,       \
                                 std::size_t, int, Buffer<double>&);                                                   \
  template void block_values<d>(const BoxLattice<d>&, const BoxRange<d>&, const BoxIndex<d>&, const BoxIndex<d>&, int, \
                                const PointView&, std::size_t, const double*, double*, std::size_t, int);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
