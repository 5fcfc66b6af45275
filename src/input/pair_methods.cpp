#include "input/pair_methods.hpp"

#include <algorithm>

#include "farfield/farfield.hpp"
#include "rbf/rbf.hpp"

namespace gaussdrift::input {

std::vector<PairMethod> pair_methods() {
  std::vector<PairMethod> found;
  for (const farfield::Method method : farfield::methods())
    if (method != farfield::Method::automatic)
      found.push_back({to_string(method), meaning(method),
                       "pairs of points: charges, logarithms, and particles that move each other"});
  for (const rbf::Method method : rbf::methods()) {
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const PairMethod& other) { return other.name == to_string(method); });
    if (method != rbf::Method::automatic && !known)
      found.push_back({to_string(method), meaning(method), "radial kernels, such as the multiquadric"});
  }
  return found;
}

}  // namespace gaussdrift::input
