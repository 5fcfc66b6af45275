// Where the points of a plan are: all of them here, or some on each of several ranks.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "farfield/catalogue.hpp"
#include "farfield/cost.hpp"

namespace farfield::detail {

/// This class itself is the case that all are here.
template <int d>
class Site {
 public:
  Site(const Problem& problem, const Options& options) : problem_(problem), options_(options) {}
  virtual ~Site() = default;
  Site(const Site&) = delete;
  Site& operator=(const Site&) = delete;

  /// Sources and targets that are kept here.
  virtual double points() const;
  /// Sums every pair.
  virtual std::unique_ptr<Summation> direct();
  virtual Tree<d> tree(std::size_t leaf_size, double smallest_side);
  virtual std::vector<LevelShare> levels(const Tree<d>& tree) const;
  /// Sums by a method that replaces clusters, those of a tree that was made here.
  virtual std::unique_ptr<Summation> clustered(typename Clustered<d>::Parts parts, const MethodEntry& method);

  /// Does work that may throw an Error, which is then thrown on all ranks.
  virtual void together(const std::function<void()>& work) const { work(); }
  virtual void sum(std::vector<std::int64_t>& /*numbers*/) const {}

 protected:
  const Problem& problem_;
  const Options& options_;
};

}  // namespace farfield::detail
