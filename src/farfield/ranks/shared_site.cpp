#include "farfield/ranks/shared_site.hpp"

#include <algorithm>
#include <limits>
#include <numeric>

#include "farfield/check.hpp"
#include "farfield/ranks/essential_tree.hpp"
#include "farfield/ranks/halo.hpp"
#include "farfield/ranks/shared_sum.hpp"

namespace farfield::detail {
namespace {

/// More points than that are cut between ranks wherever they can be: 32 leaves a rank make the parts even.
std::size_t coarse_leaf_size(std::size_t points, std::size_t ranks, std::size_t asked) {
  // No leaf of the whole tree may be larger than one of the coarse tree.
  const std::size_t least = asked > 0 ? asked : largest_leaf_size;
  return std::max(least, std::min(std::size_t{1} << 16, points / (32 * ranks)));
}

}  // namespace

template <int d>
std::unique_ptr<Summation> SharedSite<d>::direct() {
  channel_.together([&] {
    check_memory("the points of all ranks, which summing every pair needs,",
                 static_cast<double>(this->problem_.sources) * (16.0 * d + 36), this->options_.memory_limit);
  });
  return std::make_unique<SharedDirect<d>>(channel_, this->problem_, numbers_, this->options_.threads, received_);
}

template <int d>
Tree<d> SharedSite<d>::tree(std::size_t leaf_size, double smallest_side) {
  SortedPoints points;
  for (std::size_t l = 0; l < d; ++l) points.position[l] = this->problem_.source[l];
  points.original.resize(numbers_.size());
  std::iota(points.original.begin(), points.original.end(), Index{0});
  Extent extent;
  extent.include(points.position, d, {0, numbers_.size()});
  std::vector<double> ends;
  for (std::size_t l = 0; l < d; ++l) ends.insert(ends.end(), {-extent.low[l], extent.high[l]});
  channel_.max(ends);
  for (std::size_t l = 0; l < d; ++l) extent.low[l] = -ends[2 * l], extent.high[l] = ends[2 * l + 1];

  const DivisionRule fine{enclose<d>(extent), leaf_size, smallest_side};
  DivisionRule coarse = fine;
  coarse.leaf_size = coarse_leaf_size(this->problem_.sources, channel_.size(), this->options_.leaf_size);
  std::vector<Range> here;
  coarse_ = make_coarse_tree<d>(channel_, coarse, points, here);
  channel_.together([&] {
    const Range own = coarse_.own(channel_.rank());
    const auto count = static_cast<double>(own.end - own.begin);
    check_memory("the points that a rank sums for", count * (3 * (8.0 * d + 8) + 16), this->options_.memory_limit);
    if (count > std::numeric_limits<Index>::max())
      throw Error("farfield: a rank would sum for " + text(count) +
                  " points, which is more than it can count; start "
                  "more ranks");
  });
  homes_ = std::make_unique<Homes<d>>(channel_, coarse_, points, here, numbers_, own_, received_.points);
  const std::vector<Cluster> forest = make_forest<d>(coarse_, fine, channel_.rank(), own_, this->options_.threads);
  return make_essential_tree<d>(channel_, fine.cube, coarse_, forest, received_.tree);
}

template <int d>
std::vector<LevelShare> SharedSite<d>::levels(const Tree<d>& tree) const {
  return share_levels<d>(channel_, coarse_, tree);
}

template <int d>
std::unique_ptr<Summation> SharedSite<d>::clustered(typename Clustered<d>::Parts parts, const MethodEntry& method) {
  auto halo = std::make_shared<Halo<d>>(channel_, coarse_, std::move(own_), parts.tree, parts.partition, received_);
  if (parts.operators) {
    Received evaluation;
    halo->add_received(parts.operators->functions(), evaluation);
    received_.moments += evaluation.moments;
    received_.near += evaluation.near;
    parts.exchange_bytes = 2 * (evaluation.moments + evaluation.near);  // others get about as much
    parts.exchange = [halo](Buffer<double>& charges, PerCluster& moments, std::size_t functions) {
      halo->exchange(charges, moments, functions);
    };
  }
  const bool potential = this->problem_.potential;
  received_.points += homes_->received(channel_.rank(), potential);
  return std::make_unique<SharedSum<d>>(channel_, std::move(homes_), Site<d>::clustered(std::move(parts), method),
                                        potential);
}

template class SharedSite<2>;
template class SharedSite<3>;

}  // namespace farfield::detail
