#include "input/pair_methods.hpp"

#include "farfield/farfield.hpp"

namespace gaussdrift::input {

std::vector<PairMethod> pair_methods() {
  std::vector<PairMethod> found;
  for (const farfield::Method method : farfield::methods())
    if (method != farfield::Method::automatic) found.push_back({to_string(method), meaning(method)});
  return found;
}

}  // namespace gaussdrift::input
