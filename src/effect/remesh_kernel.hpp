// Kernels that share the weight of a particle among the nodes of a lattice and keep its moments. method.md, section 8.3.
#pragma once

#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"

namespace gaussdrift {

/// Along one axis; in d dimensions the kernel is the product. Lengths are in lattice spacings.
struct RemeshKernel {
  std::string_view name;
  std::string_view meaning;  // as of a NamedChoice (base/named.hpp)
  /// Moments up to this order stay: sum_i i^k weight_i = x^k for a particle at x, but for what a spread adds.
  int moments = 0;
  /// The smallest spread that goes into the weights; a smaller one stays with the blobs.
  double takes_spread = 0;
  /// What a particle at `place` gives to the nodes first, first + 1, ... If `spread` > 0, the weights of the particle's
  /// heat kernel exp(-x^2 / spread), which adds spread / 2 to the second moment.
  std::function<void(double place, double spread, std::int64_t& first, std::vector<double>& weights)> share;
};

/// In the order of docs/cases.md; the first is the default.
const std::vector<RemeshKernel>& remesh_kernels();

/// Throws std::out_of_range for an unknown name.
const RemeshKernel& find_remesh_kernel(std::string_view name);

}  // namespace gaussdrift

namespace gaussdrift::base {
template <>
std::vector<RemeshKernel>& catalogue();
}
