#include "reproduce/neighbour_boxes.hpp"

#include <numeric>

namespace gaussdrift::reproduce {

namespace {

/// All indices of axis `axis` and below, those above being settled.
void find(std::size_t axis, int n, const BoxIndices& middle, const BoxIndices& along, BoxIndices& shifted,
          std::vector<std::size_t>& found) {
  for (int k = middle[axis] - n; k <= middle[axis] + n; ++k) {
    if (k < 0 || k >= along[axis]) continue;
    shifted[axis] = k;
    if (axis == 0)
      found.push_back(box_number(shifted, along));
    else
      find(axis - 1, n, middle, along, shifted, found);
  }
}

}  // namespace

std::size_t box_number(const BoxIndices& indices, const BoxIndices& along) {
  std::size_t number = 0;
  for (std::size_t axis = along.size(); axis-- > 0;)
    number = number * static_cast<std::size_t>(along[axis]) + static_cast<std::size_t>(indices[axis]);
  return number;
}

std::vector<std::size_t> neighbour_boxes(int n, const BoxIndices& indices, const BoxIndices& along) {
  std::size_t all = 1, most = 1;
  for (const int boxes : along) all *= static_cast<std::size_t>(boxes), most *= static_cast<std::size_t>(2 * n + 1);
  std::vector<std::size_t> found;
  if (n > 0 && most >= all) {
    found.resize(all);
    std::iota(found.begin(), found.end(), std::size_t{0});
    return found;
  }
  BoxIndices shifted = indices;
  find(along.size() - 1, n, indices, along, shifted, found);
  return found;
}

}  // namespace gaussdrift::reproduce
