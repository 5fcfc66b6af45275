// What rho_eps^h is compared with: the exact density of a scene. Two classes know it: characteristics.hpp follows paths
// back to the initial density, formula.hpp evaluates an expression. method.md, section 7.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/norms.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// "characteristics", "exact", "none".
std::string to_string(ReferenceSpec::Kind kind);

class Reference {
 public:
  virtual ~Reference() = default;
  /// rho[i] = rho(x_i, time) on the lattice; NaN where it is not known, which the report counts. Times ascend from call
  /// to call.
  virtual ReferenceReport evaluate(double time, std::vector<double>& rho) = 0;
  /// Makes ready for the outputs after these, which another process has evaluated: the next ones then have the same
  /// bits as there.
  virtual void pass(const std::vector<double>& /*times*/) {}
  /// Points that are followed together, in the order of their numbers: their values depend on each other in the last
  /// digits, and on no others.
  virtual std::size_t together() const { return 1; }
  /// As evaluate(), at some of the lattice points alone, rho[i] at points[i]; at any time.
  virtual ReferenceReport evaluate_at(double time, const std::vector<std::size_t>& points,
                                      std::vector<double>& rho) const = 0;
};

}  // namespace gaussdrift
