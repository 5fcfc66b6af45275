#include "farfield/ranks/essential_tree.hpp"

#include <algorithm>

namespace farfield::detail {
namespace {

/// What another rank gets to know of a cluster.
struct ClusterHeader {
  Index number = 0;  // in its forest
  Index parent = 0;  // among those sent
  std::uint32_t sources = 0;
  std::uint8_t octant = 0;
  bool one_point = false;
};
constexpr Index is_leaf_of_coarse_tree = ~Index{0};

void shift(Range& range, std::size_t from, std::size_t to) { range = {range.begin - from + to, range.end - from + to}; }

/// The clusters that another rank needs to know, parents first: the leaves of the coarse tree that are divided for it,
/// and below them the children of all clusters that its leaves see.
template <int d>
std::vector<ClusterHeader> headers_for(const CoarseTree& coarse, const std::vector<Cluster>& forest, std::size_t rank,
                                       std::size_t other) {
  struct Open {
    Index cluster, header;
    std::vector<Index> seen_by;  // leaves of the other rank
  };
  std::vector<Index> others, own;
  for (const Index i : coarse.leaves) {
    if (coarse.is_of(coarse.clusters[i], other)) others.push_back(i);
    if (coarse.is_of(coarse.clusters[i], rank)) own.push_back(i);
  }
  std::vector<ClusterHeader> headers;
  std::vector<Open> open;
  const auto look = [&](Index i, Index place, const std::vector<Index>& leaves) {
    if (forest[i].leaf()) return;
    Open next{i, place, {}};
    for (const Index leaf : leaves)
      if (sees_children<d>(coarse.clusters[leaf], forest[i])) next.seen_by.push_back(leaf);
    if (!next.seen_by.empty()) open.push_back(std::move(next));
  };
  const auto add = [&](Index i, Index parent) {
    const Cluster& cluster = forest[i];
    headers.push_back(
        {i, parent, static_cast<std::uint32_t>(cluster.source_count()), cluster.octant, cluster.one_point});
    return static_cast<Index>(headers.size() - 1);
  };
  for (const Index i : own) {
    const std::size_t before = open.size();
    look(i, 0, others);
    if (open.size() > before) open.back().header = add(i, is_leaf_of_coarse_tree);
  }
  for (std::size_t n = 0; n < open.size(); ++n) {
    const Open parent = std::move(open[n]);
    const Cluster& cluster = forest[parent.cluster];
    for (Index c = cluster.first_child; c < cluster.first_child + cluster.children; ++c)
      look(c, add(c, parent.header), parent.seen_by);
  }
  return headers;
}

/// The forest of a rank as far as its headers show it: [number of the header].
template <int d>
std::vector<Cluster> forest_of(const std::vector<ClusterHeader>& headers, const CoarseTree& coarse) {
  std::vector<Cluster> clusters;
  std::vector<std::size_t> next;  // where the next child's points begin
  for (const ClusterHeader& one : headers) {
    Cluster cluster;
    if (one.parent == is_leaf_of_coarse_tree) {
      if (one.number >= coarse.clusters.size()) throw Error("farfield: a rank sent an unknown cluster");
      cluster = coarse.clusters[one.number];
    } else {
      if (one.parent >= clusters.size()) throw Error("farfield: a rank sent an unknown cluster");
      Cluster& parent = clusters[one.parent];
      if (parent.children++ == 0) parent.first_child = static_cast<Index>(clusters.size());
      cluster.level = static_cast<std::uint8_t>(parent.level + 1);
      cluster.octant = one.octant;
      for (std::size_t l = 0; l < d; ++l)
        cluster.cell[l] = 2 * parent.cell[l] + static_cast<std::int64_t>(one.octant >> l & 1U);
      cluster.sources = {next[one.parent], next[one.parent] + one.sources};
      next[one.parent] = cluster.sources.end;
    }
    cluster.number = one.number;
    cluster.one_point = one.one_point;
    next.push_back(cluster.sources.begin);
    clusters.push_back(cluster);
  }
  return clusters;
}

}  // namespace

template <int d>
std::vector<Cluster> make_forest(const CoarseTree& coarse, const DivisionRule& rule, std::size_t rank,
                                 SortedPoints& points, int threads) {
  std::vector<Cluster> forest = coarse.clusters;
  const std::size_t begin = coarse.begin[rank];
  std::vector<Index> own, level;
  for (const Index i : coarse.leaves)
    if (coarse.is_of(forest[i], rank)) own.push_back(i);
  for (const Index i : own) shift(forest[i].sources, begin, 0), forest[i].targets = forest[i].sources;
  Divider<d> divider(rule, points, nullptr, threads);
  level = own;
  while (!level.empty()) level = divider.divide(forest, level);
  for (const Index i : own) shift(forest[i].sources, 0, begin), forest[i].targets = forest[i].sources;
  for (std::size_t i = coarse.clusters.size(); i < forest.size(); ++i) {
    shift(forest[i].sources, 0, begin);
    forest[i].targets = forest[i].sources;
    forest[i].number = static_cast<Index>(i);
  }
  return forest;
}

template <int d>
Tree<d> make_essential_tree(const Channel& channel, const Cube& cube, const CoarseTree& coarse,
                            const std::vector<Cluster>& forest, double& received) {
  const std::size_t ranks = channel.size(), rank = channel.rank();
  std::vector<Bytes> out(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == rank) continue;
    Writer to;
    to.put_list(headers_for<d>(coarse, forest, rank, r));
    out[r] = to.take();
  }
  const std::vector<Bytes> in = channel.exchange(std::move(out), received);
  std::vector<std::vector<Cluster>> forests(ranks);
  std::vector<std::vector<Index>> place(ranks);  // of leaves of the coarse tree in these forests, by number
  struct From {
    const std::vector<Cluster>* forest;
    Index place;
  };
  std::vector<From> sent_as(coarse.clusters.size(), From{nullptr, 0});
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == rank) continue;
    const auto headers = Reader(in[r]).get_list<ClusterHeader>();
    forests[r] = forest_of<d>(headers, coarse);
    for (std::size_t i = 0; i < headers.size(); ++i)
      if (headers[i].parent == is_leaf_of_coarse_tree)
        sent_as[headers[i].number] = {&forests[r], static_cast<Index>(i)};
  }

  const Range own = coarse.own(rank);
  std::vector<Cluster> clusters;
  std::vector<From> from;
  std::vector<std::size_t> level_begin{0};
  const auto add = [&](From source, Index parent) {
    const bool is_coarse = source.forest == &forest && source.place < coarse.clusters.size();
    if (is_coarse && sent_as[source.place].forest) source = sent_as[source.place];
    Cluster cluster = (*source.forest)[source.place];
    const Range points = cluster.sources;
    cluster.parent = parent;
    cluster.part = own.begin <= points.begin && points.end <= own.end && points.begin < points.end ? Part::own
                   : !is_coarse || coarse.owner(points.begin) == coarse.owner(points.end - 1)      ? Part::foreign
                                                                                                   : Part::shared;
    const bool here = std::max(points.begin, own.begin) < std::min(points.end, own.end);
    cluster.targets = here ? points : Range{points.begin, points.begin};
    clusters.push_back(cluster);
    from.push_back(source);
  };
  add({&forest, 0}, 0);
  for (std::size_t next = 0; next < clusters.size();) {
    level_begin.push_back(clusters.size());
    for (; next < level_begin.back(); ++next) {
      const From parent = from[next];
      const Index first = clusters[next].first_child;
      if (clusters[next].children > 0) clusters[next].first_child = static_cast<Index>(clusters.size());
      for (Index c = 0; c < clusters[next].children; ++c) add({parent.forest, first + c}, static_cast<Index>(next));
    }
  }
  return Tree<d>(cube, std::move(clusters), std::move(level_begin));
}

template <int d>
std::vector<LevelShare> share_levels(const Channel& channel, const CoarseTree& coarse, const Tree<d>& tree) {
  constexpr std::size_t most = max_level + 1;
  const Range own = coarse.own(channel.rank());
  std::vector<LevelShare> shares(most);
  std::vector<std::int64_t> counts(most * channel.size());
  for (std::size_t level = 0; level < tree.levels(); ++level)
    for (std::size_t i = tree.level_begin(level); i < tree.level_begin(level + 1); ++i) {
      const Cluster& cluster = tree.clusters()[i];
      const bool begins_here = own.begin <= cluster.sources.begin && cluster.sources.begin < own.end;
      const bool is_counted = cluster.part == Part::foreign ? coarse.points() == 0 && channel.rank() == 0 : begins_here;
      if (!is_counted) continue;
      if (shares[level].count++ == 0) shares[level].first = i;
    }
  for (std::size_t level = 0; level < most; ++level)
    counts[level * channel.size() + channel.rank()] = static_cast<std::int64_t>(shares[level].count);
  channel.sum(counts);
  for (std::size_t level = 0; level < most; ++level)
    for (std::size_t r = 0; r < channel.size(); ++r) {
      const auto count = static_cast<std::size_t>(counts[level * channel.size() + r]);
      if (r < channel.rank()) shares[level].before += count;
      shares[level].total += count;
    }
  while (shares.size() > 1 && shares.back().total == 0) shares.pop_back();
  return shares;
}

template std::vector<Cluster> make_forest<2>(const CoarseTree&, const DivisionRule&, std::size_t, SortedPoints&, int);
template std::vector<Cluster> make_forest<3>(const CoarseTree&, const DivisionRule&, std::size_t, SortedPoints&, int);
template Tree<2> make_essential_tree<2>(const Channel&, const Cube&, const CoarseTree&, const std::vector<Cluster>&,
                                        double&);
template Tree<3> make_essential_tree<3>(const Channel&, const Cube&, const CoarseTree&, const std::vector<Cluster>&,
                                        double&);
template std::vector<LevelShare> share_levels<2>(const Channel&, const CoarseTree&, const Tree<2>&);
template std::vector<LevelShare> share_levels<3>(const Channel&, const CoarseTree&, const Tree<3>&);

}  // namespace farfield::detail
