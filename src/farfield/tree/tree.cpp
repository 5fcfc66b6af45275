#include "farfield/tree/tree.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"

namespace farfield::detail {
namespace {

/// Lowest and highest coordinates.
struct Extent {
  double low[3] = {HUGE_VAL, HUGE_VAL, HUGE_VAL}, high[3] = {-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void include(const Coordinates& points, std::size_t dimension, Range range) {
    for (std::size_t l = 0; l < dimension; ++l)
      for (std::size_t i = range.begin; i < range.end; ++i) {
        low[l] = std::min(low[l], points[l][i]);
        high[l] = std::max(high[l], points[l][i]);
      }
  }
  double widest(std::size_t dimension) const {
    double widest = 0;
    for (std::size_t l = 0; l < dimension; ++l) widest = std::max(widest, high[l] - low[l]);
    return widest;
  }
};

/// Second copy of the points, where parts of the array are put in order.
struct Scratch {
  SortedPoints points;
  std::vector<std::uint8_t> octant;
};

template <int d>
constexpr std::size_t octants = std::size_t{1} << d;

void copy(const Coordinates& from, std::size_t dimension, std::size_t count, SortedPoints& to) {
  for (std::size_t l = 0; l < dimension; ++l) to.position[l] = from[l];
  to.original.resize(count);
  for (std::size_t i = 0; i < count; ++i) to.original[i] = static_cast<Index>(i);
}

void make_scratch(const SortedPoints& points, std::size_t dimension, Scratch& scratch) {
  for (std::size_t l = 0; l < dimension; ++l) scratch.points.position[l].resize(points.position[l].size());
  scratch.points.original.resize(points.original.size());
  scratch.octant.resize(points.original.size());
}

/// Puts the points of a range in the order of their octants around `centre`; end[o]: end of octant o.
template <int d>
void sort_by_octant(SortedPoints& points, Scratch& scratch, Range range, const double* centre, std::size_t* end) {
  std::size_t count[octants<d>] = {};
  for (std::size_t i = range.begin; i < range.end; ++i) {
    unsigned octant = 0;
    for (unsigned l = 0; l < d; ++l) octant |= static_cast<unsigned>(points.position[l][i] >= centre[l]) << l;
    scratch.octant[i] = static_cast<std::uint8_t>(octant);
    ++count[octant];
  }
  std::size_t next[octants<d>];
  std::size_t sum = range.begin;
  for (std::size_t o = 0; o < octants<d>; ++o) {
    next[o] = sum;
    sum += count[o];
    end[o] = sum;
  }
  for (std::size_t i = range.begin; i < range.end; ++i) {
    const std::size_t to = next[scratch.octant[i]]++;
    for (std::size_t l = 0; l < d; ++l) scratch.points.position[l][to] = points.position[l][i];
    scratch.points.original[to] = points.original[i];
  }
  const auto back = [&](const auto& from, auto& to) {
    std::copy(from.begin() + static_cast<std::ptrdiff_t>(range.begin),
              from.begin() + static_cast<std::ptrdiff_t>(range.end),
              to.begin() + static_cast<std::ptrdiff_t>(range.begin));
  };
  for (std::size_t l = 0; l < d; ++l) back(scratch.points.position[l], points.position[l]);
  back(scratch.points.original, points.original);
}

/// Where the octants of a cluster end among its points.
template <int d>
struct Ends {
  std::size_t sources[octants<d>], targets[octants<d>];
  bool divided = false;
};

/// Appends the octants of cluster `number` that have points.
template <int d>
void add_children(std::vector<Cluster>& clusters, std::size_t number, const Ends<d>& ends) {
  const Cluster parent = clusters[number];
  clusters[number].first_child = static_cast<Index>(clusters.size());
  Range sources{parent.sources.begin, parent.sources.begin}, targets{parent.targets.begin, parent.targets.begin};
  for (std::size_t o = 0; o < octants<d>; ++o) {
    sources = {sources.end, ends.sources[o]};
    targets = {targets.end, ends.targets[o]};
    if (sources.begin == sources.end && targets.begin == targets.end) continue;
    Cluster child;
    child.parent = static_cast<Index>(number);
    child.level = static_cast<std::uint8_t>(parent.level + 1);
    child.octant = static_cast<std::uint8_t>(o);
    for (std::size_t l = 0; l < d; ++l) child.cell[l] = 2 * parent.cell[l] + static_cast<std::int64_t>(o >> l & 1U);
    child.sources = sources;
    child.targets = targets;
    clusters.push_back(child);
    ++clusters[number].children;
  }
}

}  // namespace

template <int d>
double Tree<d>::side(int level) const {
  return std::ldexp(side_, -level);
}

template <int d>
void Tree<d>::enclose() {
  Extent extent;
  extent.include(sources_.position, d, {0, sources_.original.size()});
  if (!self_) extent.include(targets_.position, d, {0, targets_.original.size()});
  // A corner of 10 digits after the point and a side of 8 in all: with 41 for the levels these are 53 for coordinates
  // below 4, which the engine sees to.
  double widest = 0;
  for (std::size_t l = 0; l < d; ++l) {
    corner_[l] = extent.low[l] <= extent.high[l] ? std::floor(std::ldexp(extent.low[l], 10)) / 1024 : 0;
    widest = std::max(widest, extent.high[l] - corner_[l]);
  }
  const int exponent = std::max(std::ilogb(std::max(widest, 0x1p-3)), -3) - 7;
  side_ = std::ldexp(std::floor(std::ldexp(widest, -exponent)) + 1, exponent);
}

template <int d>
Tree<d>::Tree(const Problem& problem, std::size_t leaf_size, double smallest_side, int threads) : self_(problem.self) {
  copy(problem.source, d, problem.sources, sources_);
  if (!self_) copy(problem.target, d, problem.targets, targets_);
  enclose();
  Scratch source_scratch, target_scratch;
  make_scratch(sources_, d, source_scratch);
  if (!self_) make_scratch(targets_, d, target_scratch);

  Cluster root;
  root.sources = {0, problem.sources};
  root.targets = {0, problem.targets};
  clusters_.push_back(root);
  level_begin_ = {0, 1};
  std::vector<Ends<d>> ends;
  for (int level = 0;; ++level) {
    const std::size_t begin = level_begin_[static_cast<std::size_t>(level)], end = clusters_.size();
    const bool last = level == max_level || side(level + 1) < smallest_side;
    ends.assign(end - begin, {});
    double points = 0;  // to be sorted
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t sources = clusters_[i].source_count(), targets = clusters_[i].target_count();
      if (std::max(sources, targets) > leaf_size) points += static_cast<double>(sources + targets);
    }
    gaussdrift::base::parallel_for({end - begin, 20e-9 * points}, threads, [&](std::size_t i) {
      Cluster& cluster = clusters_[begin + i];
      if (std::max(cluster.source_count(), cluster.target_count()) <= leaf_size) return;
      // Equal points cannot be divided; looked for where the last division divided nothing, and at the end.
      const Cluster& parent = clusters_[cluster.parent];
      const bool nothing_divided = level > 0 && parent.source_count() == cluster.source_count() &&
                                   parent.target_count() == cluster.target_count();
      if (nothing_divided || level == 0 || last) {
        Extent here;
        here.include(sources_.position, d, cluster.sources);
        if (!self_) here.include(targets_.position, d, cluster.targets);
        cluster.one_point = here.widest(d) == 0;
      }
      if (last || cluster.one_point) return;
      double middle[d];
      for (std::size_t l = 0; l < d; ++l) middle[l] = centre(cluster, l);
      sort_by_octant<d>(sources_, source_scratch, cluster.sources, middle, ends[i].sources);
      if (self_) {
        std::copy_n(ends[i].sources, octants<d>, ends[i].targets);
      } else {
        sort_by_octant<d>(targets_, target_scratch, cluster.targets, middle, ends[i].targets);
      }
      ends[i].divided = true;
    });
    for (std::size_t i = 0; i < end - begin; ++i)
      if (ends[i].divided) add_children<d>(clusters_, begin + i, ends[i]);
    if (clusters_.size() == end) break;
    level_begin_.push_back(clusters_.size());
  }
}

template <int d>
void Tree<d>::prune(std::size_t leaf_size) {
  constexpr Index gone = ~Index{0};
  std::vector<Cluster> kept;
  std::vector<Index> number(clusters_.size(), gone);
  std::vector<std::size_t> level_begin{0};
  for (std::size_t level = 0; level < levels(); ++level) {
    for (std::size_t i = level_begin_[level]; i < level_begin_[level + 1]; ++i) {
      Cluster cluster = clusters_[i];
      if (level > 0) {
        if (number[cluster.parent] == gone || kept[number[cluster.parent]].children == 0) continue;
        cluster.parent = number[cluster.parent];
        if (kept[cluster.parent].first_child == gone)
          kept[cluster.parent].first_child = static_cast<Index>(kept.size());
      }
      if (std::max(cluster.source_count(), cluster.target_count()) <= leaf_size) cluster.children = 0;
      cluster.first_child = gone;
      number[i] = static_cast<Index>(kept.size());
      kept.push_back(cluster);
    }
    if (kept.size() == level_begin.back()) break;
    level_begin.push_back(kept.size());
  }
  for (Cluster& cluster : kept)
    if (cluster.first_child == gone) cluster.first_child = 0;
  clusters_ = std::move(kept);
  level_begin_ = std::move(level_begin);
}

template <int d>
bool touch(const Cluster& a, const Cluster& b) {
  const Cluster &coarse = a.level <= b.level ? a : b, &fine = a.level <= b.level ? b : a;
  const int levels = fine.level - coarse.level;
  for (std::size_t l = 0; l < d; ++l) {
    const std::int64_t low = coarse.cell[l] << levels, high = (coarse.cell[l] + 1) << levels;
    if (fine.cell[l] < low - 1 || fine.cell[l] > high) return false;
  }
  return true;
}

template class Tree<2>;
template class Tree<3>;
template bool touch<2>(const Cluster&, const Cluster&);
template bool touch<3>(const Cluster&, const Cluster&);

}  // namespace farfield::detail
