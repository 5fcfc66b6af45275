// Every method of summation as one object: its name, what it is good for, what others have to know of it, and how its
// sum is made. The choice of a method, the checks of arguments, the names in files and what is printed all ask this list.
#pragma once

#include <memory>
#include <string>
#include <tuple>
#include <vector>

#include "farfield/tree/clustered.hpp"

namespace farfield::detail {

/// The sum over clusters that have been found and paired.
template <int d>
using MakeClustered = std::unique_ptr<Summation> (*)(const Problem& problem, typename Clustered<d>::Parts parts);

struct MethodEntry {
  Method method;
  std::string name;     // as in files
  std::string meaning;  // for users: how it sums, and when it is good

  /// Clusters of sources act in place of their points: it has a tree, degrees and a bound that follows the tolerance.
  bool replaces_clusters = false;
  /// They act on clusters of targets.
  bool couples_clusters = false;
  /// In 2 and in 3 dimensions. Null without clusters: a Site sums every pair of the points that it has.
  std::tuple<MakeClustered<2>, MakeClustered<3>> make = {};
};

/// All of them, `direct` first.
const std::vector<MethodEntry>& catalogue();

/// Null for `automatic` and numbers that are no method.
const MethodEntry* find_entry(Method method);

}  // namespace farfield::detail
