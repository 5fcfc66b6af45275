#include "farfield/tree/division.hpp"

#include <algorithm>
#include <numeric>

#include "base/parallel.hpp"

namespace farfield::detail {

void make_scratch(const SortedPoints& points, std::size_t dimension, Scratch& scratch) {
  for (std::size_t l = 0; l < dimension; ++l) scratch.points.position[l].resize(points.position[l].size());
  scratch.points.original.resize(points.original.size());
  scratch.octant.resize(points.original.size());
}

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

template <int d>
Divider<d>::Divider(const DivisionRule& rule, SortedPoints& sources, SortedPoints* targets, int threads)
    : rule_(rule), sources_(sources), targets_(targets), threads_(threads) {
  make_scratch(sources, d, source_scratch_);
  if (targets) make_scratch(*targets, d, target_scratch_);
}

template <int d>
void Divider<d>::divide(Cluster& cluster, bool may_be_one_point, Ends<d>& ends) {
  if (may_be_one_point) {
    Extent here;
    here.include(sources_.position, d, cluster.sources);
    if (targets_) here.include(targets_->position, d, cluster.targets);
    cluster.one_point = here.widest(d) == 0;
  }
  if (rule_.is_last(cluster) || cluster.one_point) return;
  double middle[d];
  for (std::size_t l = 0; l < d; ++l) middle[l] = rule_.cube.centre(cluster, l);
  sort_by_octant<d>(sources_, source_scratch_, cluster.sources, middle, ends.sources);
  if (targets_) {
    sort_by_octant<d>(*targets_, target_scratch_, cluster.targets, middle, ends.targets);
  } else {
    std::copy_n(ends.sources, octants<d>, ends.targets);
  }
  ends.divided = true;
}

template <int d>
std::vector<Index> Divider<d>::divide(std::vector<Cluster>& clusters, const std::vector<Index>& some) {
  std::vector<Ends<d>> ends(some.size());
  double points = 0;  // to be sorted
  for (const Index i : some)
    if (!rule_.is_small(clusters[i]))
      points += static_cast<double>(clusters[i].source_count() + clusters[i].target_count());
  gaussdrift::base::parallel_for({some.size(), 20e-9 * points}, threads_, [&](std::size_t n) {
    Cluster& cluster = clusters[some[n]];
    if (!rule_.is_small(cluster)) divide(cluster, rule_.may_be_one_point(clusters, cluster), ends[n]);
  });
  const std::size_t before = clusters.size();
  for (std::size_t n = 0; n < some.size(); ++n)
    if (ends[n].divided) add_children<d>(clusters, some[n], ends[n]);
  std::vector<Index> children(clusters.size() - before);
  std::iota(children.begin(), children.end(), static_cast<Index>(before));
  return children;
}

template void sort_by_octant<2>(SortedPoints&, Scratch&, Range, const double*, std::size_t*);
template void sort_by_octant<3>(SortedPoints&, Scratch&, Range, const double*, std::size_t*);
template void add_children<2>(std::vector<Cluster>&, std::size_t, const Ends<2>&);
template void add_children<3>(std::vector<Cluster>&, std::size_t, const Ends<3>&);
template class Divider<2>;
template class Divider<3>;

}  // namespace farfield::detail
