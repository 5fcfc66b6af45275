#include "farfield/ranks/halo.hpp"

#include <algorithm>

namespace farfield::detail {
namespace {

std::size_t count_of(const std::vector<Range>& ranges) {
  std::size_t count = 0;
  for (const Range& range : ranges) count += range.end - range.begin;
  return count;
}

/// Sorts ranges and joins those that follow each other or overlap.
void join(std::vector<Range>& ranges) {
  std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
  std::vector<Range> joined;
  for (const Range& range : ranges) {
    if (range.begin == range.end) continue;
    if (!joined.empty() && range.begin <= joined.back().end) {
      joined.back().end = std::max(joined.back().end, range.end);
    } else {
      joined.push_back(range);
    }
  }
  ranges = std::move(joined);
}

/// Marks the clusters of other ranks whose moments give those of `cluster`.
void want_moments(const std::vector<Cluster>& clusters, Index cluster, std::vector<char>& wanted) {
  if (wanted[cluster] || clusters[cluster].part == Part::own) return;
  wanted[cluster] = true;
  if (clusters[cluster].part == Part::foreign) return;
  for (Index c = 0; c < clusters[cluster].children; ++c)
    want_moments(clusters, clusters[cluster].first_child + c, wanted);
}

/// Ranges of all ranks' points, and where they are here.
class Places {
 public:
  explicit Places(std::vector<Range> ranges) : ranges_(std::move(ranges)) {
    for (const Range& range : ranges_)
      begin_.push_back(begin_.empty() ? 0 : end_), end_ = begin_.back() + (range.end - range.begin);
  }
  std::size_t count() const { return end_; }
  const std::vector<Range>& ranges() const { return ranges_; }
  /// False if not all of the range are here.
  bool find(Range& range) const {
    const auto next = std::upper_bound(ranges_.begin(), ranges_.end(), range.begin,
                                       [](std::size_t point, const Range& some) { return point < some.begin; });
    if (next == ranges_.begin()) return false;
    const Range& found = *(next - 1);
    if (range.end > found.end) return false;
    const std::size_t begin =
        begin_[static_cast<std::size_t>(next - ranges_.begin()) - 1] + (range.begin - found.begin);
    range = {begin, begin + (range.end - range.begin)};
    return true;
  }

 private:
  std::vector<Range> ranges_;
  std::vector<std::size_t> begin_;
  std::size_t end_ = 0;
};

}  // namespace

template <int d>
std::vector<typename Halo<d>::Wanted> Halo<d>::ask(const Tree<d>& tree, const Partition& partition,
                                                   const CoarseTree& coarse) {
  const auto& clusters = tree.clusters();
  std::vector<char> moments(clusters.size());
  for (const CouplingChunk& chunk : partition.couplings)
    for (const CouplingChunk::Pair& pair : chunk.pairs) want_moments(clusters, pair.source, moments);
  for (const Index i : partition.from_clusters.entries) want_moments(clusters, i, moments);

  const Range own = coarse.own(channel_.rank());
  std::vector<Range> points = partition.runs.entries;
  for (const Index i : partition.from_points.entries) points.push_back(clusters[i].sources);
  // Vectors read targets past the end of a leaf, and take another formula if one of them is near: those that follow the
  // last leaf have to be the same for any number of ranks.
  if (own.begin < own.end) points.push_back({own.begin, std::min(own.end + padding, coarse.points())});
  join(points);

  std::vector<Wanted> wanted(channel_.size());
  for (Index i = 0; i < clusters.size(); ++i)
    if (moments[i] && clusters[i].part == Part::foreign)
      wanted[coarse.owner(clusters[i].sources.begin)].moments.push_back(i);
  for (Range range : points)
    while (range.begin < range.end) {
      const std::size_t rank = coarse.owner(range.begin), end = std::min(range.end, coarse.begin[rank + 1]);
      wanted[rank].points.push_back({range.begin, end});
      range.begin = end;
    }
  return wanted;
}

template <int d>
Halo<d>::Halo(const Channel& channel, const CoarseTree& coarse, SortedPoints own, Tree<d>& tree, Partition& partition,
              Received& received)
    : channel_(channel) {
  const std::size_t ranks = channel.size(), rank = channel.rank();
  std::vector<Wanted> wanted = ask(tree, partition, coarse);
  std::vector<Bytes> out(ranks);
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == rank) continue;
    std::vector<Index> numbers;
    for (const Index i : wanted[r].moments) numbers.push_back(tree.clusters()[i].number);
    Writer to;
    to.put_list(numbers);
    to.put_list(wanted[r].points);
    out[r] = to.take();
  }
  const std::vector<Bytes> in = channel.exchange(std::move(out), received.tree);

  std::vector<Index> place;  // of its own clusters, by their number
  for (Index i = 0; i < tree.clusters().size(); ++i) {
    const Cluster& cluster = tree.clusters()[i];
    if (cluster.part != Part::own) continue;
    if (place.size() <= cluster.number) place.resize(cluster.number + std::size_t{1});
    place[cluster.number] = i;
  }
  give_.resize(ranks);
  std::vector<Bytes> positions(ranks);
  const std::size_t begin = coarse.begin[rank];
  for (std::size_t r = 0; r < ranks; ++r) {
    if (r == rank) continue;
    Reader from(in[r]);
    for (const Index number : from.get_list<Index>()) give_[r].moments.push_back(place.at(number));
    Writer to;
    for (const Range& range : from.get_list<Range>()) {
      give_[r].points.push_back({range.begin - begin, range.end - begin});
      for (std::size_t l = 0; l < d; ++l)
        to.put(own.position[l].data() + (range.begin - begin), range.end - range.begin);
    }
    positions[r] = to.take();
  }
  positions = channel.exchange(std::move(positions), received.near);
  place_points(own, positions, wanted, coarse, tree, partition);
}

template <int d>
void Halo<d>::place_points(const SortedPoints& own, const std::vector<Bytes>& positions,
                           const std::vector<Wanted>& wanted, const CoarseTree& coarse, Tree<d>& tree,
                           Partition& partition) {
  std::vector<Range> all;
  for (const Wanted& some : wanted) all.insert(all.end(), some.points.begin(), some.points.end());
  join(all);
  const Places places(std::move(all));

  SortedPoints here;
  here.original = own.original;
  for (std::size_t l = 0; l < d; ++l) here.position[l].assign(places.count() + padding, 0.0);
  Range mine = coarse.own(channel_.rank());
  if (mine.begin == mine.end || !places.find(mine)) mine = {0, 0};
  for (std::size_t l = 0; l < d; ++l)
    std::copy_n(own.position[l].begin(), mine.end - mine.begin,
                here.position[l].begin() + static_cast<std::ptrdiff_t>(mine.begin));
  take_.resize(channel_.size());
  for (auto& pieces : give_)
    for (Range& piece : pieces.points) piece = {piece.begin + mine.begin, piece.end + mine.begin};
  for (std::size_t r = 0; r < take_.size(); ++r) {
    if (r == channel_.rank()) continue;
    take_[r] = wanted[r];
    Reader from(positions[r]);
    for (Range& piece : take_[r].points) {
      places.find(piece);
      for (std::size_t l = 0; l < d; ++l) from.get(here.position[l].data() + piece.begin, piece.end - piece.begin);
    }
  }

  std::vector<Cluster> clusters = tree.clusters();
  for (Cluster& cluster : clusters) {
    places.find(cluster.sources);  // others have their number of sources alone
    if (cluster.part == Part::own) cluster.targets = cluster.sources;
  }
  for (Range& run : partition.runs.entries) places.find(run);
  tree.take_points(std::move(here), mine.begin, std::move(clusters));
}

template <int d>
void Halo<d>::exchange(Buffer<double>& charges, PerCluster& moments, std::size_t functions) const {
  std::vector<Bytes> out(channel_.size());
  for (std::size_t r = 0; r < out.size(); ++r) {
    Writer to;
    for (const Index i : give_[r].moments) to.put(moments.data() + i * functions, functions);
    for (const Range& range : give_[r].points) to.put(charges.data() + range.begin, range.end - range.begin);
    out[r] = to.take();
  }
  const std::vector<Bytes> in = channel_.exchange(std::move(out));
  for (std::size_t r = 0; r < in.size(); ++r) {
    Reader from(in[r]);
    for (const Index i : take_[r].moments) from.get(moments.data() + i * functions, functions);
    for (const Range& range : take_[r].points) from.get(charges.data() + range.begin, range.end - range.begin);
  }
}

template <int d>
void Halo<d>::add_received(std::size_t functions, Received& received) const {
  for (const Wanted& some : take_) {
    received.moments += sizeof(double) * static_cast<double>(some.moments.size() * functions);
    received.near += sizeof(double) * static_cast<double>(count_of(some.points));
  }
}

template class Halo<2>;
template class Halo<3>;

}  // namespace farfield::detail
