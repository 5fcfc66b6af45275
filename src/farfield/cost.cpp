#include "farfield/cost.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace farfield::detail {
namespace {

// Measured by tools/bench/bench_farfield on 3 GHz with AVX2. The first two were fitted with AVX-512 relative to the
// seconds of a pair; two thirds of them, or twice, choose leaves that are as fast within 8 %.
constexpr double multiplication = 0.07e-9;    // within a product of matrices
constexpr double moved_number = 1.0e-9;       // gathered, scattered
constexpr double function_at_point = 0.9e-9;  // moments; expansion of potential and field twice as much
constexpr double sorted_point = 40e-9;        // on every level of the tree
constexpr double listed_coupling = 60e-9;
constexpr double small_things = 1.5e-3;

constexpr std::size_t samples_a_level = 200;

/// Sizes of leaves to choose from.
constexpr std::size_t sizes[] = {
    8, 11, 16, 23, 32, 45, 64, 90, 128, 181, 256, 362, 512, 724, 1024, 1448, 2048, 2896, largest_leaf_size};
constexpr std::size_t size_count = std::size(sizes);

/// Seconds of a sample for every leaf size, added up from events that happen for a whole interval of sizes.
class BySize {
 public:
  /// For leaf sizes s with low <= s < high.
  void add(std::size_t low, std::size_t high, double seconds) {
    const auto place = [](std::size_t s) {
      return static_cast<std::size_t>(std::lower_bound(sizes, sizes + size_count, s) - sizes);
    };
    if (low >= high) return;
    change_[place(low)] += seconds;
    change_[place(high)] -= seconds;
  }
  /// From each size to the next, beginning with those of the first.
  const std::array<double, size_count + 1>& changes() const { return change_; }

 private:
  std::array<double, size_count + 1> change_{};
};

/// Seconds of many samples. They are summed as whole numbers, so that their order does not matter, nor which rank has
/// which sample.
class SecondsOfSamples {
 public:
  void add(const BySize& sample) {
    for (std::size_t i = 0; i <= size_count; ++i) {
      const double seconds = std::clamp(sample.changes()[i], -most, most), whole = std::floor(seconds);
      whole_[2 * i] += static_cast<std::int64_t>(whole);
      whole_[2 * i + 1] += std::llround(std::ldexp(seconds - whole, digits));
    }
  }
  std::vector<std::int64_t>& whole() { return whole_; }
  Prediction best(std::size_t smallest) const {
    Prediction best;
    double sum = 0;
    for (std::size_t i = 0; i < size_count; ++i) {
      sum += static_cast<double>(whole_[2 * i]) + std::ldexp(static_cast<double>(whole_[2 * i + 1]), -digits);
      if (sizes[i] < smallest) continue;
      if (best.leaf_size == 0 || sum < best.seconds) best = {sizes[i], sum};
    }
    return best;
  }

 private:
  static constexpr double most = 1e13;  // seconds of a sample
  static constexpr int digits = 44;     // of 2: 6e-14 seconds, and room for 500 000 samples
  std::vector<std::int64_t> whole_ = std::vector<std::int64_t>(2 * (size_count + 1));
};

std::size_t larger_count(const Cluster& cluster) { return std::max(cluster.source_count(), cluster.target_count()); }

/// Clusters of sources that touch a cluster: of its level, or larger leaves.
template <int d>
void next_colleagues(const Tree<d>& tree, const Cluster& target, const std::vector<Index>& of_parent,
                     std::vector<Index>& touching, std::vector<Index>& apart) {
  touching.clear();
  apart.clear();
  const auto visit = [&](Index s) {
    if (tree.clusters()[s].source_count() > 0) (touch<d>(target, tree.clusters()[s]) ? touching : apart).push_back(s);
  };
  for (const Index c : of_parent) {
    const Cluster& cluster = tree.clusters()[c];
    if (cluster.leaf()) {
      visit(c);
    } else {
      for (Index s = cluster.first_child; s < cluster.first_child + cluster.children; ++s) visit(s);
    }
  }
}

}  // namespace

double pair_seconds(const Problem& problem, Precision precision) {
  switch (problem.interaction) {
    case Interaction::inverse:
      return precision == Precision::six_digits ? 0.5e-9 : precision == Precision::ten_digits ? 1.3e-9 : 1.55e-9;
    case Interaction::logarithm:
      return problem.potential ? 2.4e-9 : 0.8e-9;
    default:
      return 2e-9;  // 0.7e-9 beyond the core, 3.5e-9 within
  }
}

template <int d>
Costs<d>::Costs(const Problem& problem, const Degrees<d>& degrees, Precisions precisions)
    : nodes_(nodes_of_degree<d>(degrees.one_sided)) {
  const double functions = static_cast<double>(detail::functions<d>(degrees.highest));
  transfer_ = functions * functions * multiplication + 3 * functions * moved_number;
  moments_ = functions * function_at_point;
  expansion_ = 2 * functions * function_at_point;
  pair_ = pair_seconds(problem, precisions.points);
  Problem far;
  far.interaction = d == 3 ? Interaction::inverse : Interaction::logarithm;
  far.potential = problem.potential;
  substitute_pair_ = pair_seconds(far, precisions.substitutes);
  setup_ = small_things + functions * functions * static_cast<double>(nodes_) * fitted_number;
  double all = 0;
  for (std::size_t number = 0; number < octant_offsets<d>; ++number) {
    const int degree = degrees.at_offset[number];
    if (degree == 0) continue;
    const double nodes = static_cast<double>(nodes_of_degree<d>(degree));
    couplings_setup_ += nodes * nodes * table_entry;
    unsigned coupled = 0;
    std::size_t rest = number, reflections = 1;
    for (unsigned l = 0; l < d; ++l) {
      if (rest % (farthest + 1) != 0) {
        coupled |= 1U << l;
        reflections *= 2;
      }
      rest /= farthest + 1;
    }
    double size[std::size_t{1} << d] = {};
    for (std::size_t k = 0; k < detail::functions<d>(degree); ++k) ++size[parity<d>(k) & ~coupled];
    for (const double s : size) coupling_[number] += s * s * multiplication + 2 * s * moved_number;
    all += coupling_[number] * static_cast<double>(reflections);
  }
  // For points that fill a cube. A leaf has 3^d leaves pair by pair, and couplings at 6^d - 3^d offsets, those of 7^d -
  // 3^d that its place in the parent allows. At the best size both cost the same.
  const double near = d == 3 ? 27 : 9, far_clusters = d == 3 ? 189 : 27, offsets = d == 3 ? 316 : 40;
  good_leaf_size_ = std::sqrt(all * far_clusters / offsets / (near * pair_));
}

namespace {

/// The work of a cluster and all that it has beside and above it, by the leaf sizes for which it comes about.
template <int d>
class Work {
 public:
  Work(const Tree<d>& fine, const Costs<d>& costs, bool couple) : fine_(fine), costs_(costs), couple_(couple) {}

  /// Cluster i stands for `weight` clusters of its level.
  BySize of(std::size_t i, double weight) {
    seconds_ = {};
    const Cluster& cluster = fine_.clusters()[i];
    const std::size_t own = larger_count(cluster), above = divided_above(cluster);
    const std::size_t leaf_from = cluster.leaf() ? 0 : own;  // is a leaf for sizes leaf_from <= s < above
    const double sources = static_cast<double>(cluster.source_count()),
                 targets = static_cast<double>(cluster.target_count());
    if (cluster.level > 0) {
      seconds_.add(0, above, weight * (sources + (fine_.self() ? 0 : targets)) * sorted_point);
      seconds_.add(0, above, weight * costs_.transfer() * ((sources > 0) + (couple_ && targets > 0)));
    }
    seconds_.add(
        leaf_from, above,
        weight * (sources * costs_.moments_of_point() + (couple_ ? targets : 0) * costs_.expansion_at_point()));
    if (cluster.target_count() == 0) return seconds_;
    find_colleagues(i);
    for (const Index s : colleagues_)
      seconds_.add(leaf_from, above,
                   weight * targets * static_cast<double>(fine_.clusters()[s].source_count()) * costs_.pair());
    for (const Index s : apart_) add_apart(cluster, fine_.clusters()[s], weight);
    return seconds_;
  }

 private:
  /// The leaf size from which on the parent of a cluster is a leaf.
  std::size_t divided_above(const Cluster& cluster) const {
    constexpr std::size_t any = ~std::size_t{0};
    return cluster.level == 0 ? any : larger_count(fine_.clusters()[cluster.parent]);
  }

  /// Down from the root to cluster i, with what touches on the way.
  void find_colleagues(std::size_t i) {
    chain_.assign(1, static_cast<Index>(i));
    while (fine_.clusters()[chain_.back()].level > 0) chain_.push_back(fine_.clusters()[chain_.back()].parent);
    colleagues_.clear();
    if (fine_.clusters()[0].source_count() > 0) colleagues_.push_back(0);
    apart_.clear();
    for (std::size_t n = chain_.size() - 1; n-- > 0;) {
      next_colleagues<d>(fine_, fine_.clusters()[chain_[n]], colleagues_, touching_, apart_);
      colleagues_.swap(touching_);
    }
  }

  /// Sources of a cluster that does not touch.
  void add_apart(const Cluster& cluster, const Cluster& other, double weight) {
    const std::size_t above = divided_above(cluster), divided = divided_above(other);
    const double targets = static_cast<double>(cluster.target_count()),
                 count = static_cast<double>(other.source_count());
    const double pairs = weight * targets * count * costs_.pair();
    if (other.level != cluster.level) {  // a larger leaf
      seconds_.add(0, above, pairs);
      return;
    }
    const bool replaced = other.source_count() > costs_.nodes();
    double event = replaced ? weight * targets * static_cast<double>(costs_.nodes()) * costs_.substitute_pair() : pairs;
    if (couple_) {
      int k[3] = {};
      for (std::size_t l = 0; l < d; ++l) k[l] = static_cast<int>(std::abs(cluster.cell[l] - other.cell[l]));
      event = weight * (costs_.coupling(k) + listed_coupling);
    }
    seconds_.add(0, std::min(above, divided), event);
    seconds_.add(divided, above, pairs);  // the other is not divided down to here
  }

  const Tree<d>& fine_;
  const Costs<d>& costs_;
  const bool couple_;
  BySize seconds_;
  std::vector<Index> chain_, colleagues_, touching_, apart_;
};

}  // namespace

template <int d>
Prediction predict(const Tree<d>& fine, std::size_t fine_leaf_size, const Costs<d>& costs, bool couple,
                   const std::vector<LevelShare>& shares, const SumOverRanks& sum) {
  SecondsOfSamples seconds;
  Work<d> work(fine, costs, couple);
  for (const LevelShare& level : shares) {
    const std::size_t step = (level.total + samples_a_level - 1) / samples_a_level, end = level.before + level.count;
    if (level.count == 0) continue;
    for (std::size_t n = (level.before + step - 1) / step * step; n < end; n += step)
      seconds.add(work.of(level.first + n - level.before, static_cast<double>(std::min(step, level.total - n))));
  }
  sum(seconds.whole());
  BySize setup;
  setup.add(0, larger_count(fine.clusters()[0]), costs.setup(couple));
  seconds.add(setup);
  return seconds.best(fine_leaf_size);
}

template class Costs<2>;
template class Costs<3>;
template Prediction predict<2>(const Tree<2>&, std::size_t, const Costs<2>&, bool, const std::vector<LevelShare>&,
                               const SumOverRanks&);
template Prediction predict<3>(const Tree<3>&, std::size_t, const Costs<3>&, bool, const std::vector<LevelShare>&,
                               const SumOverRanks&);

}  // namespace farfield::detail
