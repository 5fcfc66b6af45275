#include "farfield/tree/partition.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/parallel.hpp"

namespace farfield::detail {
namespace {

constexpr std::size_t piece = 64;  // clusters handled together

template <class Entry>
double bytes_of(const Lists<Entry>& lists) {
  return static_cast<double>(lists.begin.size() * sizeof(std::size_t) + lists.entries.size() * sizeof(Entry));
}

/// Lists of the clusters begin .. end appended; make(i, list) fills that of cluster i, in about 2 microseconds.
template <class Entry, class Make>
void append_lists(Lists<Entry>& lists, std::size_t begin, std::size_t end, int threads, const Make& make) {
  const std::size_t pieces = (end - begin + piece - 1) / piece;
  std::vector<std::vector<Entry>> entries(pieces);
  std::vector<std::size_t> count(end - begin);
  gaussdrift::base::parallel_for({pieces, 2e-6 * static_cast<double>(end - begin)}, threads, [&](std::size_t p) {
    for (std::size_t i = begin + p * piece; i < std::min(end, begin + (p + 1) * piece); ++i) {
      const std::size_t before = entries[p].size();
      make(i, entries[p]);
      count[i - begin] = entries[p].size() - before;
    }
  });
  if (lists.begin.empty()) lists.begin.push_back(0);
  for (const std::size_t c : count) lists.begin.push_back(lists.begin.back() + c);
  for (const auto& part : entries) lists.entries.insert(lists.entries.end(), part.begin(), part.end());
}

template <int d>
class Maker {
 public:
  Maker(const Tree<d>& tree, const PartitionOptions& options)
      : tree_(tree), clusters_(tree.clusters()), options_(options) {}

  Partition make() {
    for (std::size_t level = 0; level < tree_.levels(); ++level) {
      const std::size_t begin = tree_.level_begin(level), end = tree_.level_begin(level + 1);
      append_lists(colleagues_, begin, end, options_.threads,
                   [&](std::size_t i, auto& list) { find_colleagues(i, list); });
      append_lists(coarse_, begin, end, options_.threads,
                   [&](std::size_t i, auto& list) { find_coarse(i, list, nullptr); });
      append_lists(partition_.from_points, begin, end, options_.threads,
                   [&](std::size_t i, auto& list) { find_coarse(i, unused(), &list); });
      if (options_.couple) find_couplings(level);
    }
    append_lists(partition_.runs, 0, clusters_.size(), options_.threads,
                 [&](std::size_t i, auto& list) { find_near(i, &list, nullptr); });
    append_lists(partition_.from_clusters, 0, clusters_.size(), options_.threads,
                 [&](std::size_t i, auto& list) { find_near(i, nullptr, &list); });
    return std::move(partition_);
  }

 private:
  using List = std::vector<Index>;

  static List& unused() {
    thread_local List list;
    list.clear();
    return list;
  }

  /// Clusters of its level with sources that it touches or, if nothing is to be coupled, all of them that are children
  /// of the parent's colleagues.
  void find_colleagues(std::size_t i, List& list) const {
    const Cluster& target = clusters_[i];
    if (target.target_count() == 0) return;
    if (target.level == 0) {
      if (target.source_count() > 0) list.push_back(0);
      return;
    }
    for_each_candidate(target, [&](Index s) {
      if (touch<d>(target, clusters_[s])) list.push_back(s);
    });
  }

  template <class Use>
  void for_each_candidate(const Cluster& target, const Use& use) const {
    const Index* const near = colleagues_.first(target.parent);
    for (std::size_t n = 0; n < colleagues_.count(target.parent); ++n) {
      const Cluster& cluster = clusters_[near[n]];
      for (Index s = cluster.first_child; s < cluster.first_child + cluster.children; ++s)
        if (clusters_[s].source_count() > 0) use(s);
    }
  }

  /// Potentials of the leaf at the nodes of a cluster of targets beside its field times the cluster's side: a charge
  /// may be as far away as the leaf is wide. 1/r over 1/r^2; in 2D ln r over 1/r, where ln r follows from the unit.
  static double steepness(const Cluster& target, const Cluster& leaf) {
    const double ratio = std::ldexp(1.0, target.level - leaf.level);
    return d == 3 ? ratio : ratio * (1 + leaf.level * std::numbers::ln2);
  }

  /// Larger leaves of sources that it touches, or has too few targets for; the others go to `from_points`.
  void find_coarse(std::size_t i, List& list, List* from_points) const {
    const Cluster& target = clusters_[i];
    if (target.level == 0 || target.target_count() == 0) return;
    const auto add = [&](Index s) {
      const bool apart = options_.couple && target.target_count() > options_.enough &&
                         !touch<d>(target, clusters_[s]) && steepness(target, clusters_[s]) <= options_.steepest_fit;
      if (!apart) list.push_back(s);
      if (apart && from_points) from_points->push_back(s);
    };
    const Index* const coarse = coarse_.first(target.parent);
    for (std::size_t n = 0; n < coarse_.count(target.parent); ++n) add(coarse[n]);
    const Index* const near = colleagues_.first(target.parent);
    for (std::size_t n = 0; n < colleagues_.count(target.parent); ++n)
      if (clusters_[near[n]].leaf()) add(near[n]);
  }

  void find_couplings(std::size_t level) {
    const std::size_t begin = tree_.level_begin(level), end = tree_.level_begin(level + 1);
    const std::size_t chunks = (end - begin + CouplingChunk::size - 1) / CouplingChunk::size;
    std::vector<CouplingChunk> made(chunks);
    constexpr double a_cluster = d == 3 ? 3e-6 : 0.6e-6;
    gaussdrift::base::parallel_for(
        {chunks, a_cluster * static_cast<double>(end - begin)}, options_.threads, [&](std::size_t c) {
          constexpr int span = 7;  // offsets -3 .. 3 an axis
          std::array<std::size_t, span * span * span + 1> first{};
          struct Found {
            std::size_t number;
            CouplingChunk::Pair pair;
          };
          std::vector<Found> found;
          for (std::size_t t = begin + c * CouplingChunk::size;
               t < std::min(end, begin + (c + 1) * CouplingChunk::size); ++t) {
            const Cluster& target = clusters_[t];
            if (target.level == 0 || target.target_count() == 0) continue;
            for_each_candidate(target, [&](Index s) {
              if (touch<d>(target, clusters_[s])) return;
              std::size_t number = 0;
              for (std::size_t l = 0; l < d; ++l)
                number = number * span + static_cast<std::size_t>(target.cell[l] - clusters_[s].cell[l] + 3);
              found.push_back({number, {static_cast<Index>(t), s}});
              ++first[number + 1];
            });
          }
          CouplingChunk& chunk = made[c];
          chunk.level = static_cast<int>(level);
          for (std::size_t n = 0; n + 1 < first.size(); ++n) {
            if (first[n + 1] > 0) {
              CouplingChunk::Group group{{}, first[n] + first[n + 1]};
              std::size_t rest = n;
              for (std::size_t l = d; l-- > 0;) {
                group.k[l] = static_cast<int>(rest % span) - 3;
                rest /= span;
              }
              chunk.groups.push_back(group);
            }
            first[n + 1] += first[n];
          }
          chunk.pairs.resize(found.size());
          for (const Found& f : found) chunk.pairs[first[f.number]++] = f.pair;
        });
    for (CouplingChunk& chunk : made)
      if (!chunk.pairs.empty()) partition_.couplings.push_back(std::move(chunk));
  }

  /// For a leaf of targets: sources pair by pair, and smaller clusters that are far enough.
  void find_near(std::size_t i, std::vector<Range>* runs, List* from_clusters) const {
    const Cluster& target = clusters_[i];
    if (!target.leaf() || target.target_count() == 0) return;
    std::vector<Range> ranges;
    const auto add_run = [&](const Cluster& cluster) {
      // Points that all are one: every distance is 0.
      if (cluster.one_point && &cluster == &target) return;
      if (runs) ranges.push_back(cluster.sources);
    };
    const Index* const coarse = coarse_.first(i);
    for (std::size_t n = 0; n < coarse_.count(i); ++n) add_run(clusters_[coarse[n]]);
    std::vector<Index> open;
    const auto visit = [&](Index s, bool touches) {
      const Cluster& cluster = clusters_[s];
      if (cluster.source_count() == 0) return;
      if (!touches && cluster.source_count() > options_.enough) {
        if (from_clusters) from_clusters->push_back(s);
      } else if (!touches || cluster.leaf()) {
        add_run(cluster);
      } else {
        open.push_back(s);
      }
    };
    const auto close = [&] {
      while (!open.empty()) {
        const Cluster& cluster = clusters_[open.back()];
        open.pop_back();
        for (Index s = cluster.first_child; s < cluster.first_child + cluster.children; ++s)
          visit(s, touch<d>(target, clusters_[s]));
      }
    };
    const Index* const near = colleagues_.first(i);
    for (std::size_t n = 0; n < colleagues_.count(i); ++n) visit(near[n], true);
    close();
    if (!options_.couple) {
      // Nothing was coupled on the way down: for every ancestor the clusters that it would have been coupled with.
      for (std::size_t t = i; clusters_[t].level > 0; t = clusters_[t].parent)
        for_each_candidate(clusters_[t], [&](Index s) {
          if (!touch<d>(clusters_[t], clusters_[s])) visit(s, false);
        });
    }
    if (!runs) return;
    std::sort(ranges.begin(), ranges.end(), [](const Range& a, const Range& b) { return a.begin < b.begin; });
    const std::size_t first = runs->size();
    for (const Range& range : ranges) {
      if (runs->size() > first && runs->back().end == range.begin) {
        runs->back().end = range.end;
      } else {
        runs->push_back(range);
      }
    }
  }

  const Tree<d>& tree_;
  const std::vector<Cluster>& clusters_;
  const PartitionOptions options_;
  Lists<Index> colleagues_, coarse_;
  Partition partition_;
};

}  // namespace

double Partition::bytes() const {
  double sum = bytes_of(from_points) + bytes_of(runs) + bytes_of(from_clusters);
  for (const CouplingChunk& chunk : couplings)
    sum += static_cast<double>(chunk.pairs.size() * sizeof(CouplingChunk::Pair) +
                               chunk.groups.size() * sizeof(CouplingChunk::Group));
  return sum;
}

template <int d>
Partition make_partition(const Tree<d>& tree, const PartitionOptions& options) {
  return Maker<d>(tree, options).make();
}

template <int d>
Work work_of(const Partition& partition, const Tree<d>& tree, std::size_t nodes,
             const std::function<bool(Index)>& counts) {
  Work work;
  const auto& clusters = tree.clusters();
  const auto nodes_of = static_cast<double>(nodes);
  for (const CouplingChunk& chunk : partition.couplings)
    for (const CouplingChunk::Pair& pair : chunk.pairs) work.couplings += counts(pair.target);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    if (!counts(static_cast<Index>(i))) continue;
    const auto targets = static_cast<double>(clusters[i].target_count());
    for (std::size_t n = 0; n < partition.runs.count(i); ++n) {
      const Range& run = partition.runs.first(i)[n];
      work.pairs += targets * static_cast<double>(run.end - run.begin);
    }
    work.substitute_pairs += targets * nodes_of * static_cast<double>(partition.from_clusters.count(i));
    for (std::size_t n = 0; n < partition.from_points.count(i); ++n)
      work.substitute_pairs +=
          nodes_of * static_cast<double>(clusters[partition.from_points.first(i)[n]].source_count());
  }
  return work;
}

template Work work_of<2>(const Partition&, const Tree<2>&, std::size_t, const std::function<bool(Index)>&);
template Work work_of<3>(const Partition&, const Tree<3>&, std::size_t, const std::function<bool(Index)>&);
template Partition make_partition<2>(const Tree<2>&, const PartitionOptions&);
template Partition make_partition<3>(const Tree<3>&, const PartitionOptions&);

}  // namespace farfield::detail
