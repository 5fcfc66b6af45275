#include "farfield/ranks/coarse_tree.hpp"

#include <algorithm>
#include <cstdlib>

namespace farfield::detail {
namespace {

template <int d>
class Maker {
 public:
  Maker(const Channel& channel, const DivisionRule& rule, SortedPoints& points)
      : channel_(channel), rule_(rule), points_(points) {
    make_scratch(points, d, scratch_);
    std::vector<std::int64_t> count{static_cast<std::int64_t>(points.original.size())};
    channel.sum(count);
    Cluster root;
    root.sources = root.targets = {0, static_cast<std::size_t>(count[0])};
    clusters_.push_back(root);
    here_.push_back({0, points.original.size()});
  }

  void make() {
    std::vector<Index> level{0};
    while (!level.empty()) {
      level.erase(std::remove_if(level.begin(), level.end(), [&](Index i) { return rule_.is_small(clusters_[i]); }),
                  level.end());
      find_single_points(level);
      level.erase(std::remove_if(level.begin(), level.end(),
                                 [&](Index i) { return clusters_[i].one_point || rule_.is_last(clusters_[i]); }),
                  level.end());
      level = divide(level);
    }
  }

  CoarseTree take(std::vector<Range>& here) {
    CoarseTree tree;
    std::vector<Index> open{0};
    while (!open.empty()) {
      const Index i = open.back();
      open.pop_back();
      if (clusters_[i].leaf()) {
        tree.leaves.push_back(i);
        here.push_back(here_[i]);
      }
      for (Index c = clusters_[i].children; c-- > 0;) open.push_back(clusters_[i].first_child + c);
    }
    for (Index i = 0; i < clusters_.size(); ++i) clusters_[i].number = i;
    tree.clusters = std::move(clusters_);
    share(tree);
    return tree;
  }

 private:
  void find_single_points(const std::vector<Index>& level) {
    std::vector<Index> some;
    for (const Index i : level)
      if (rule_.may_be_one_point(clusters_, clusters_[i])) some.push_back(i);
    std::vector<double> ends;
    for (const Index i : some) {
      Extent extent;
      extent.include(points_.position, d, here_[i]);
      for (int l = 0; l < d; ++l) ends.insert(ends.end(), {-extent.low[l], extent.high[l]});
    }
    if (some.empty()) return;
    channel_.max(ends);
    for (std::size_t n = 0; n < some.size(); ++n) {
      bool one = true;
      for (std::size_t l = 0; l < d; ++l) one = one && -ends[2 * (n * d + l)] == ends[2 * (n * d + l) + 1];
      clusters_[some[n]].one_point = one;
    }
  }

  std::vector<Index> divide(const std::vector<Index>& level) {
    if (level.empty()) return {};
    std::vector<Ends<d>> local(level.size());
    std::vector<std::int64_t> count;
    for (std::size_t n = 0; n < level.size(); ++n) {
      const Range here = here_[level[n]];
      double middle[d];
      for (std::size_t l = 0; l < d; ++l) middle[l] = rule_.cube.centre(clusters_[level[n]], l);
      sort_by_octant<d>(points_, scratch_, here, middle, local[n].sources);
      for (std::size_t o = 0; o < octants<d>; ++o)
        count.push_back(static_cast<std::int64_t>(local[n].sources[o] - (o ? local[n].sources[o - 1] : here.begin)));
    }
    channel_.sum(count);
    const std::size_t before = clusters_.size();
    for (std::size_t n = 0; n < level.size(); ++n) {
      Ends<d> ends;
      std::size_t sum = clusters_[level[n]].sources.begin, begin = here_[level[n]].begin;
      for (std::size_t o = 0; o < octants<d>; ++o) {
        const auto points = static_cast<std::size_t>(count[n * octants<d> + o]);
        ends.sources[o] = ends.targets[o] = sum += points;
        if (points > 0) here_.push_back({begin, local[n].sources[o]});
        begin = local[n].sources[o];
      }
      add_children<d>(clusters_, level[n], ends);
    }
    std::vector<Index> children;
    for (std::size_t i = before; i < clusters_.size(); ++i) children.push_back(static_cast<Index>(i));
    return children;
  }

  /// Cuts the list of leaves: each belongs to the rank whose part of all points its middle is in.
  void share(CoarseTree& tree) const {
    const std::size_t ranks = channel_.size(), points = tree.points();
    tree.begin.assign(ranks + 1, points);
    tree.begin[0] = 0;
    std::size_t next = 1;
    for (const Index i : tree.leaves) {
      const Range range = tree.clusters[i].sources;
      const auto middle = static_cast<double>(range.begin + range.end) / 2;
      for (; next < ranks &&
             middle >= static_cast<double>(next) / static_cast<double>(ranks) * static_cast<double>(points);
           ++next)
        tree.begin[next] = range.begin;
    }
  }

  const Channel& channel_;
  const DivisionRule& rule_;
  SortedPoints& points_;
  Scratch scratch_;
  std::vector<Cluster> clusters_;
  std::vector<Range> here_;  // the points of this rank, by cluster
};

}  // namespace

std::size_t CoarseTree::owner(std::size_t point) const {
  return static_cast<std::size_t>(std::upper_bound(begin.begin(), begin.end(), point) - begin.begin()) - 1;
}

template <int d>
CoarseTree make_coarse_tree(const Channel& channel, const DivisionRule& rule, SortedPoints& points,
                            std::vector<Range>& here) {
  Maker<d> maker(channel, rule, points);
  maker.make();
  return maker.take(here);
}

template <int d>
bool sees_children(const Cluster& leaf, const Cluster& cluster) {
  if (leaf.level < cluster.level) return touch<d>(leaf, cluster);
  const int levels = leaf.level - cluster.level;
  for (std::size_t l = 0; l < d; ++l)
    if (std::abs((leaf.cell[l] >> levels) - cluster.cell[l]) > 1) return false;
  return true;
}

template CoarseTree make_coarse_tree<2>(const Channel&, const DivisionRule&, SortedPoints&, std::vector<Range>&);
template CoarseTree make_coarse_tree<3>(const Channel&, const DivisionRule&, SortedPoints&, std::vector<Range>&);
template bool sees_children<2>(const Cluster&, const Cluster&);
template bool sees_children<3>(const Cluster&, const Cluster&);

}  // namespace farfield::detail
