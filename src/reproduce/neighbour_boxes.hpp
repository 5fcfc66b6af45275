// The subboxes of [Sch06, 3.3]: their numbers, and the neighbours of one of them.
#pragma once

#include <cstddef>
#include <vector>

namespace gaussdrift::reproduce {

/// Boxes along each axis, or the indices of one box, first axis first.
using BoxIndices = std::vector<int>;

/// i = i_1 + i_2 n_1 + i_3 n_1 n_2 + ... [Sch06, 3.3.2]
std::size_t box_number(const BoxIndices& indices, const BoxIndices& along);

/// The numbers of the boxes up to n away on each axis, in the order in which the recursion finds them; all boxes in
/// their order if (2n + 1)^d are no fewer than there are [Sch06, Algorithms 3.4 and 3.5].
std::vector<std::size_t> neighbour_boxes(int n, const BoxIndices& indices, const BoxIndices& along);

}  // namespace gaussdrift::reproduce
