// Scattered targets of `spread`: the filter from the lattice around the sources to the lattice around the targets, and
// phi from there to each target. Targets that a brick does not reach are left out; they add exactly nothing.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.hpp"
#include "fgtd/spread/sum.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t piece = 4096;  // targets at a time

/// The targets near one brick: sorted by cell, from the anchor, and the lattice around them.
template <int d>
struct NearTargets {
  Buffer<std::uint32_t> index;  // the caller's numbers, sorted
  Buffer<double> position;      // [index.size()][d]
  Brick<d> brick;
};

/// Where targets are near a brick, and the targets as seen from the anchor.
template <int d>
class Vicinity {
 public:
  Vicinity(const LatticeFrame<d>& frame, const Brick<d>& source, int reach, const double* targets)
      : anchor_(frame.anchor), targets_(targets) {
    for (std::size_t l = 0; l < d; ++l) {  // first nodes within reach
      const double first = static_cast<double>(source.first[l]), nodes = static_cast<double>(source.nodes[l]);
      from_[l] = (first - reach - frame.width) * frame.spacing;
      to_[l] = (first + nodes + reach + frame.width) * frame.spacing;
    }
  }

  std::array<double, d> from_anchor(std::size_t i) const {
    std::array<double, d> y;
    for (std::size_t l = 0; l < d; ++l) y[l] = targets_[i * d + l] - anchor_[l];
    return y;
  }

  bool has(const std::array<double, d>& y) const {
    bool inside = true;
    for (std::size_t l = 0; l < d; ++l) inside = inside && from_[l] <= y[l] && y[l] <= to_[l];
    return inside;
  }

 private:
  const std::array<double, d> anchor_;
  const double* targets_;
  std::array<double, d> from_, to_;
};

/// How many targets are near, and their extent.
template <int d>
struct Found {
  std::size_t count = 0;
  std::array<double, d> low, high;

  Found() {
    low.fill(std::numeric_limits<double>::infinity());
    high.fill(-std::numeric_limits<double>::infinity());
  }

  void take(const std::array<double, d>& least, const std::array<double, d>& most) {
    for (std::size_t l = 0; l < d; ++l) {
      low[l] = std::min(low[l], least[l]);
      high[l] = std::max(high[l], most[l]);
    }
  }
};

/// The brick around near targets of that extent: one node to spare on each side.
template <int d>
Brick<d> brick_of_targets(const LatticeFrame<d>& frame, const Found<d>& all) {
  std::array<std::int64_t, d> low, high;
  for (std::size_t l = 0; l < d; ++l) {
    low[l] = frame.first_node(all.low[l]);
    high[l] = frame.first_node(all.high[l]);
  }
  return brick_around<d>(low, high, frame.width);
}

template <int d>
NearTargets<d> find_near(const LatticeFrame<d>& frame, const Brick<d>& source, int reach, const double* targets,
                         std::size_t count, int threads) {
  const Vicinity<d> vicinity(frame, source, reach, targets);
  const std::size_t pieces = (count + piece - 1) / piece;
  std::vector<Found<d>> found(pieces);
  const gaussdrift::base::Pieces parts(pieces, 0.3 * cost::spread_sort * static_cast<double>(count));
  gaussdrift::base::parallel_for(parts, threads, [&](std::size_t p) {
    Found<d> here;
    for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) {
      const std::array<double, d> y = vicinity.from_anchor(i);
      if (!vicinity.has(y)) continue;
      ++here.count;
      here.take(y, y);
    }
    found[p] = here;
  });
  Found<d> all;
  for (Found<d>& part : found) {
    all.take(part.low, part.high);
    all.count += std::exchange(part.count, all.count);  // from now on those before it
  }
  NearTargets<d> near;
  if (all.count == 0) return near;
  near.brick = brick_of_targets<d>(frame, all);
  Buffer<std::uint32_t> index(all.count), cell(all.count);
  gaussdrift::base::parallel_for(parts, threads, [&](std::size_t p) {
    std::size_t at = found[p].count;
    for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) {
      if (!vicinity.has(vicinity.from_anchor(i))) continue;
      index[at] = static_cast<std::uint32_t>(i);
      cell[at++] = static_cast<std::uint32_t>(near.brick.cell_of(frame, vicinity.from_anchor(i)));
    }
  });
  near.index.resize(all.count);
  near.position.resize(d * all.count);
  std::vector<std::uint32_t> first;
  sort_into_cells(cell, near.brick.cell_count(), threads, first, [&](std::size_t j, std::size_t place) {
    near.index[place] = index[j];
    const std::array<double, d> y = vicinity.from_anchor(index[j]);
    std::copy_n(y.begin(), d, near.position.begin() + static_cast<std::ptrdiff_t>(place * d));
  });
  return near;
}

}  // namespace

template <int d>
int SpreadSum<d>::lattice_reach() const {
  int reach = 0;
  for (const SpreadPart& part : parts_) reach = std::max(reach, part.filter->lattice_reach());
  return reach;
}

template <int d>
Buffer<double> SpreadSum<d>::filtered(const std::vector<Request<d>>& requests, const Brick<d>& source,
                                      const Brick<d>& target) const {
  FilterTargets<d> nodes;
  nodes.on_lattice = true;
  for (std::size_t l = 0; l < d; ++l) {
    // the padding of axis 0 stays zero
    const std::size_t used =
        target.nodes[l] - (l == 0 ? SpreadFilter::padded_window - static_cast<std::size_t>(layout_.frame.width) : 0);
    for (std::size_t i = 0; i < used; ++i) nodes.node[l].push_back(target.first[l] + static_cast<std::int64_t>(i));
  }
  const std::size_t size = target.size(), outputs = requests[0].combinations.size() * columns_;
  Buffer<double> lattice(outputs * size + SpreadFilter::padded_window);
  std::fill_n(lattice.end() - SpreadFilter::padded_window, SpreadFilter::padded_window, 0.0);
  for (std::size_t k = 0; k < parts_.size(); ++k)
    apply_filter<d>({*parts_[k].filter,
                     layout_.frame,
                     parts_[k].sigma,
                     requests[k],
                     columns_,
                     {&source},
                     {lattice_.data() + columns_ * source.offset},
                     threads_,
                     k > 0},
                    nodes, target.nodes[0], size, lattice.data());
  return lattice;
}

template <int d>
void SpreadSum<d>::evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const {
  evaluate(std::vector<Request<d>>{request}, targets, count, values);
}

template <int d>
void SpreadSum<d>::evaluate(const std::vector<Request<d>>& requests, const double* targets, std::size_t count,
                            double* values) const {
  const std::size_t outputs = requests[0].combinations.size() * columns_;
  in_pieces(outputs * count, cost::spread_value, threads_,
            [&](std::size_t begin, std::size_t end) { std::fill(values + begin, values + end, 0.0); });
  if (outputs == 0 || count == 0) return;
  for (const auto& brick : layout_.bricks) {
    const NearTargets<d> near = find_near<d>(layout_.frame, brick, lattice_reach(), targets, count, threads_);
    const std::size_t near_count = near.index.size();
    if (near_count == 0) continue;
    Buffer<double> lattice = filtered(requests, brick, near.brick);

    const gaussdrift::base::Pieces pieces((near_count + piece - 1) / piece,
                                          at_lattice(near_count, outputs, cost::spread_gather));
    gaussdrift::base::parallel_for(pieces, threads_, [&](std::size_t i) {
      SpreadJob gather = job_for(near.brick);
      gather.position = near.position.data();
      gather.begin = i * piece;
      gather.end = std::min(near_count, (i + 1) * piece);
      gather.columns = outputs;
      gather.lattice = lattice.data();
      std::vector<double> out(outputs * piece);
      gather.out = out.data();
      gather.out_stride = piece;
      kernels().spread(gather);
      for (std::size_t output = 0; output < outputs; ++output)
        for (std::size_t j = gather.begin; j < gather.end; ++j)
          values[output * count + near.index[j]] += out[output * piece + j - gather.begin];
    });
  }
}

/// The lattice around the targets is no larger than what the brick reaches.
template <int d>
double SpreadSum<d>::point_bytes(const Request<d>& request, std::size_t count) const {
  const double outputs = static_cast<double>(request.combinations.size() * columns_);
  double largest = 0;
  for (const auto& brick : layout_.bricks) {
    double nodes = 1;
    std::array<double, d> sizes;
    for (std::size_t l = 0; l < d; ++l) {
      sizes[l] = static_cast<double>(brick.nodes[l]) + 2 * (lattice_reach() + layout_.frame.width) +
                 SpreadFilter::padded_window + 2;
      nodes *= sizes[l];
    }
    for (const SpreadPart& part : parts_) {
      const FilterJob<d> job{*part.filter, layout_.frame, part.sigma, request, columns_, {&brick}, {nullptr}, threads_};
      largest = std::max(largest, 8 * outputs * nodes + filter_bytes<d>(job, sizes, true));
    }
  }
  return largest + static_cast<double>(count) * (8 * d + 16) +
         8 * outputs * static_cast<double>(piece) * gaussdrift::base::resolve_threads(threads_);
}

#define FGTD_INSTANTIATE(d)                                                                                        \
  template int SpreadSum<d>::lattice_reach() const;                                                                \
  template Buffer<double> SpreadSum<d>::filtered(const std::vector<Request<d>>&, const Brick<d>&, const Brick<d>&) \
      const;                                                                                                       \
  template void SpreadSum<d>::evaluate(const Request<d>&, const double*, std::size_t, double*) const;              \
  template void SpreadSum<d>::evaluate(const std::vector<Request<d>>&, const double*, std::size_t, double*) const; \
  template double SpreadSum<d>::point_bytes(const Request<d>&, std::size_t) const;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
