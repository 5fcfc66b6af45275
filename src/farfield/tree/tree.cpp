#include "farfield/tree/tree.hpp"

#include <algorithm>
#include <utility>

#include "farfield/tree/division.hpp"

namespace farfield::detail {
namespace {

void copy(const Coordinates& from, std::size_t dimension, std::size_t count, SortedPoints& to) {
  for (std::size_t l = 0; l < dimension; ++l) to.position[l] = from[l];
  to.original.resize(count);
  for (std::size_t i = 0; i < count; ++i) to.original[i] = static_cast<Index>(i);
}

}  // namespace

template <int d>
Tree<d>::Tree(const Problem& problem, std::size_t leaf_size, double smallest_side, int threads) : self_(problem.self) {
  copy(problem.source, d, problem.sources, sources_);
  if (!self_) copy(problem.target, d, problem.targets, targets_);
  Extent extent;
  extent.include(sources_.position, d, {0, problem.sources});
  if (!self_) extent.include(targets_.position, d, {0, problem.targets});
  cube_ = enclose<d>(extent);

  Cluster root;
  root.sources = {0, problem.sources};
  root.targets = {0, problem.targets};
  clusters_.push_back(root);
  level_begin_ = {0, 1};
  Divider<d> divider({cube_, leaf_size, smallest_side}, sources_, self_ ? nullptr : &targets_, threads);
  std::vector<Index> level{0};
  while (!(level = divider.divide(clusters_, level)).empty()) level_begin_.push_back(clusters_.size());
}

template <int d>
void Tree<d>::take_points(SortedPoints points, std::size_t own_begin, std::vector<Cluster> clusters) {
  sources_ = std::move(points);
  own_begin_ = own_begin;
  clusters_ = std::move(clusters);
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

template class Tree<2>;
template class Tree<3>;

}  // namespace farfield::detail
