#include "farfield/choose.hpp"

#include <algorithm>
#include <cmath>

#include "farfield/catalogue.hpp"
#include "farfield/check.hpp"
#include "farfield/cost.hpp"

namespace farfield::detail {
namespace {

/// The part of the tolerance that treating a blob as a point may cost.
double core_share(const Problem& problem) { return problem.interaction == Interaction::blob ? 0.1 : 0; }

/// The part of the tolerance that rounding may cost where potentials at the nodes of a cluster are fitted.
constexpr double fit_share = 0.125;

/// The steepest fit (partition.hpp) that keeps this part. A fit enlarges rounding less than 10 times
/// (interpolation.cpp), differentiating a polynomial 2 n^2 times (Markov), and a charge may be twice as far away as its
/// leaf is wide.
double steepest_fit(double tolerance, int degree) {
  constexpr double rounding = 2.2e-16;
  return fit_share * tolerance / (rounding * 10 * 2 * degree * degree * 2);
}

/// exp(-r^2/eps^2) is below that share at the smallest distance of clusters that are coupled.
double smallest_side(const Problem& problem, double tolerance) {
  if (problem.interaction != Interaction::blob) return 0;
  return std::sqrt(std::log(1 / (core_share(problem) * tolerance)) / problem.inverse_squared_core);
}

template <int d>
double clusters_bytes(double points, std::size_t leaf_size) {
  return points * (2 * (8.0 * d + 4) + 1) + 2 * points / static_cast<double>(leaf_size) * 1.2 * sizeof(Cluster);
}

/// A method that replaces clusters, with its best leaf size and seconds.
struct Found {
  const MethodEntry* method = nullptr;
  Prediction prediction;
};

/// The method asked for, or the fastest of all; the last in the catalogue of those that are equally fast.
template <int d>
Found choose_method(const Tree<d>& tree, std::size_t fine_leaf_size, const Costs<d>& costs, const Site<d>& site,
                    Method asked) {
  const std::vector<LevelShare> levels = site.levels(tree);
  const auto sum = [&](std::vector<std::int64_t>& numbers) { site.sum(numbers); };
  Found best;
  for (const MethodEntry& method : catalogue()) {
    if (!method.replaces_clusters || (asked != Method::automatic && asked != method.method)) continue;
    const Prediction found = predict<d>(tree, fine_leaf_size, costs, method.couples_clusters, levels, sum);
    if (!best.method || found.seconds <= best.prediction.seconds) best = {&method, found};
  }
  return best;
}

/// The work for targets that are counted here, and by the clusters of all ranks.
template <int d>
Work count_work(const Partition& partition, const Tree<d>& tree, const Site<d>& site,
                const std::vector<LevelShare>& levels, std::size_t nodes, Work& everywhere) {
  const Work here = work_of<d>(partition, tree, nodes, [&](Index i) {
    const LevelShare& level = levels[tree.clusters()[i].level];
    return level.first <= i && i < level.first + level.count;
  });
  std::vector<std::int64_t> counts;  // exact below 2^53
  for (const double count : {here.pairs, here.substitute_pairs, here.couplings})
    counts.push_back(static_cast<std::int64_t>(count));
  site.sum(counts);
  everywhere = {static_cast<double>(counts[0]), static_cast<double>(counts[1]), static_cast<double>(counts[2])};
  return here;
}

/// Prepares the sum over the clusters of `tree`, of leaves of choice.leaf_size; `bytes` are those of tree and points.
template <int d>
std::unique_ptr<Summation> make_clustered(const MethodEntry& method, const Options& options, Tree<d> tree,
                                          const Degrees<d>& degrees, const Costs<d>& costs, Precisions precisions,
                                          double bytes, Site<d>& site, Choice& choice) {
  const bool couple = method.couples_clusters;
  const std::vector<LevelShare> levels = site.levels(tree);
  choice.degree = degrees.highest;
  choice.clusters = 0;
  for (const LevelShare& level : levels) choice.clusters += level.total;
  choice.levels = static_cast<int>(levels.size());
  // A cluster has at most as many couplings as its place in the parent allows offsets.
  const double clusters = static_cast<double>(tree.clusters().size()), offsets = d == 3 ? 189 : 27;
  site.together([&] {
    check_memory("the block partition and the coefficients",
                 bytes + clusters * (couple ? offsets * sizeof(CouplingChunk::Pair) : 64) +
                     clusters * 8.0 * static_cast<double>(functions<d>(degrees.highest)) * (couple ? 2 : 1),
                 options.memory_limit);
  });
  std::shared_ptr<const Operators<d>> operators;  // a single cluster needs none
  if (choice.clusters > 1) operators = Operators<d>::get(degrees, couple, options.threads);
  Partition partition = make_partition<d>(tree, {.enough = costs.nodes(),
                                                 .couple = couple,
                                                 .steepest_fit = steepest_fit(options.tolerance, degrees.one_sided),
                                                 .threads = options.threads});
  const Work work = count_work<d>(partition, tree, site, levels, costs.nodes(), choice.work);
  return site.clustered(
      {std::move(tree), std::move(partition), std::move(operators), precisions, options.threads, work}, method);
}

}  // namespace

template <int d>
std::unique_ptr<Summation> choose_summation(const Problem& problem, const Options& options, Site<d>& site,
                                            Choice& choice) {
  const double pairs = static_cast<double>(problem.sources) * static_cast<double>(problem.targets);
  const double direct_seconds = pairs * pair_seconds(problem, Precision::full);
  const auto direct = [&] {
    choice.method = Method::direct;
    choice.bound = error_of(Precision::full);
    choice.seconds = direct_seconds;
    choice.work = {.pairs = pairs};
    check_seconds(choice.method, choice.seconds, options.most_seconds);
    return site.direct();
  };
  const bool any = options.method == Method::automatic;
  if (options.method == Method::direct) return direct();

  // The table holds the largest error of one charge at one target, so the promise holds for every target and charge.
  const double kept = 1 - core_share(problem), smallest = Degrees<d>::smallest_error() / (kept - fit_share);
  if (options.tolerance < smallest) {
    if (any) return direct();
    throw ToleranceError("farfield: Options::tolerance = " + text(options.tolerance) + " cannot be promised by " +
                         to_string(options.method) + " here, must be at least " + text(smallest) +
                         "; leave the method to auto or direct");
  }
  const Precisions precisions = precisions_for(options.tolerance, problem.interaction);
  const double rounded = std::max(substitution_error(precisions.substitutes), fit_share * options.tolerance);
  const Degrees<d> degrees(options.tolerance * kept, options.tolerance * kept - rounded);
  const Costs<d> costs(problem, degrees, precisions);
  if (any && problem.sources + problem.targets < 1000) return direct();  // nothing to be gained, not even by floats

  // Single precision gains even where one cluster holds all; else the tables alone have to be worth it.
  if (any && precisions.points != Precision::six_digits && direct_seconds < 1.5 * costs.setup(false)) return direct();

  const double good = costs.good_leaf_size();
  const std::size_t fine_leaf_size =
      options.leaf_size > 0 ? options.leaf_size : static_cast<std::size_t>(std::clamp(good / 6, 8.0, 1024.0));
  const double tree_bytes =
      8.0 * d * site.points() * (problem.self ? 2 : 1) + clusters_bytes<d>(site.points(), fine_leaf_size);
  site.together([&] { check_memory("the tree", tree_bytes, options.memory_limit); });
  Tree<d> tree = site.tree(fine_leaf_size, smallest_side(problem, options.tolerance));

  const auto [method, prediction] = choose_method<d>(tree, fine_leaf_size, costs, site, options.method);
  if (any && direct_seconds < prediction.seconds) return direct();

  if (options.leaf_size == 0) tree.prune(prediction.leaf_size);
  choice.method = method->method;
  choice.seconds = prediction.seconds;
  check_seconds(choice.method, choice.seconds, options.most_seconds);
  choice.bound =
      std::max(std::max(degrees.error, degrees.one_sided_error + rounded) + core_share(problem) * options.tolerance,
               error_of(precisions.points));
  choice.leaf_size = options.leaf_size > 0 ? options.leaf_size : prediction.leaf_size;
  return make_clustered<d>(*method, options, std::move(tree), degrees, costs, precisions, tree_bytes, site, choice);
}

template std::unique_ptr<Summation> choose_summation<2>(const Problem&, const Options&, Site<2>&, Choice&);
template std::unique_ptr<Summation> choose_summation<3>(const Problem&, const Options&, Site<3>&, Choice&);

}  // namespace farfield::detail
