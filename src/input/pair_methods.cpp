#include "input/pair_methods.hpp"

#include <algorithm>

#include "farfield/farfield.hpp"
#include "farfield/general.hpp"
#include "rbf/rbf.hpp"

namespace gaussdrift::input {

namespace {

template <class Method>
void add(const std::vector<Method>& methods, const char* sums, std::vector<PairMethod>& found) {
  for (const Method method : methods) {
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const PairMethod& other) { return other.name == to_string(method); });
    if (method != Method::automatic && !known) found.push_back({to_string(method), meaning(method), sums});
  }
}

}  // namespace

std::vector<PairMethod> pair_methods() {
  std::vector<PairMethod> found;
  add(farfield::methods(), "pairs of points: charges, logarithms, and particles that move each other", found);
  add(rbf::methods(), "radial kernels, such as the multiquadric", found);
  add(farfield::general_methods(), "kernels that are an expression of r, as `sum --kernel` takes them", found);
  return found;
}

}  // namespace gaussdrift::input
