// The points of a plan are on several ranks. docs/farfield.md, "On several ranks".
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "farfield/ranks/coarse_tree.hpp"
#include "farfield/ranks/homes.hpp"
#include "farfield/site.hpp"

namespace farfield::detail {

/// `problem` counts the points of all ranks, but has those of this rank alone.
template <int d>
class SharedSite : public Site<d> {
 public:
  SharedSite(const Problem& problem, const Options& options, const Channel& channel,
             std::span<const std::int64_t> numbers, Received& received)
      : Site<d>(problem, options), channel_(channel), numbers_(numbers), received_(received) {}

  double points() const override { return static_cast<double>(numbers_.size()); }
  std::unique_ptr<Summation> direct() override;
  Tree<d> tree(std::size_t leaf_size, double smallest_side) override;
  std::vector<LevelShare> levels(const Tree<d>& tree) const override;
  std::unique_ptr<Summation> clustered(typename Clustered<d>::Parts parts, const MethodEntry& method) override;
  void together(const std::function<void()>& work) const override { channel_.together(work); }
  void sum(std::vector<std::int64_t>& numbers) const override { channel_.sum(numbers); }

 private:
  const Channel& channel_;
  const std::span<const std::int64_t> numbers_;  // of the points of this rank
  Received& received_;
  // Of the last tree.
  CoarseTree coarse_;
  std::unique_ptr<Homes<d>> homes_;
  SortedPoints own_;
};

}  // namespace farfield::detail
