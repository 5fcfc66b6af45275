// Does a list have a thing with some property?
#pragma once

#include <algorithm>
#include <vector>

namespace gaussdrift::base {

/// Has one of the things this property?
template <class Thing>
bool has_one(const std::vector<Thing>& things, bool Thing::*property) {
  return std::any_of(things.begin(), things.end(), [&](const Thing& thing) { return thing.*property; });
}

}  // namespace gaussdrift::base
