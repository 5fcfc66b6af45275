// Every method of summation as one object: its names, its proposal and how it tells its parameters. The choice of a
// method, Plan, the names in files and what is printed all ask this list.
//
// To add a method: its folder, with a class derived from Summation and a function that returns its MethodEntry; that
// function in the list of catalogue.cpp; its value of Method and its parameters in fgtd.hpp; its sources in CMakeLists.txt.
// The tests over all methods then hold it to the promise.
#pragma once

#include <functional>
#include <iosfwd>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "fgtd/choose.hpp"
#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

struct MethodEntry {
  Method method;
  std::string name;     // as in files
  std::string meaning;  // for users: how it sums, and when it is good

  /// Seconds that a search for its parameters takes. It is left out where the best method so far is about as fast.
  double search_seconds = 0;

  /// Proposes the method in 1, 2, 3 and 4 dimensions: with the cheapest of its parameters that are proven to keep the
  /// tolerance. None if it cannot keep the promise there, or would need more than the memory limit. Throws
  /// MemoryLimitError if the method is asked for by name and no parameters fit the limit.
  std::tuple<Proposer<1>, Proposer<2>, Proposer<3>, Proposer<4>> propose;

  /// Prints its parameters as the middle of a line: ", box side 0.1, 9 nodes an axis". Null if it has none.
  std::function<void(std::ostream&, const Choice&)> print = nullptr;
  /// The same as names and values, for JSON.
  std::function<std::vector<Parameter>(const Choice&)> parameters = nullptr;
};

/// All of them, `direct` first.
const std::vector<MethodEntry>& catalogue();

/// Null for `automatic` and numbers that are no method.
const MethodEntry* find_entry(Method method);

/// Adds a method of a test to those of the library, before any plan is made: its number is given by `add_method`, and
/// returned. Its choice keeps the parameters of `direct`, which are none.
Method add_method(MethodEntry entry);

}  // namespace fgtd::detail
