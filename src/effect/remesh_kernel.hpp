// Kernels that share the weight of a particle among the nodes of a lattice and keep its moments. method.md, section 8.3.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift {

/// Along one axis; in d dimensions the kernel is the product. Lengths are in lattice spacings. Moments up to moments()
/// stay: sum_i i^k weight_i = x^k for a particle at x, but for what a spread adds (below).
///   gauss8     the Gaussian of width 2 with derivatives up to order 6; moments 1 .. 7 vanish. It is smooth, so it also
///              suits particles that no longer stand on a lattice, as long as they overlap.
///   lambda44   Lambda_{4,4} [CEPP14], piecewise of degree 9 and four times differentiable. It needs a quarter of the
///              nodes an axis, for particles that have hardly moved against each other since they stood on a lattice.
///   lambda66   Lambda_{6,6}
///   m4prime    Lambda_{2,1}, Monaghan's M4'
class RemeshKernel {
 public:
  /// Throws std::out_of_range for an unknown name.
  explicit RemeshKernel(std::string_view name);

  int moments() const { return p_ > 0 ? p_ : 7; }

  /// What a particle at `place` gives to the nodes first, first + 1, ... If `spread` > 0, the weights of the particle's
  /// heat kernel exp(-x^2 / spread), which adds spread / 2 to the second moment. A piecewise kernel takes up no spread
  /// below takes_spread().
  void share(double place, double spread, std::int64_t& first, std::vector<double>& weights) const;

  /// The smallest spread that goes into the weights.
  double takes_spread() const { return p_ > 0 ? 2.25 : 0; }

 private:
  int p_, r_;                                     // Lambda_{p,r}; 0: gauss8
  std::vector<std::vector<double>> polynomials_;  // of Lambda, one a node, lowest power first
};

/// All names, the default first.
const std::vector<std::string>& remesh_kernel_names();

}  // namespace gaussdrift
