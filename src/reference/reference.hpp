// What rho_eps^h is compared with: the exact density of a scene. Two classes know it: characteristics.hpp follows paths
// back to the initial density, formula.hpp evaluates an expression. method.md, section 7.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/points.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift {

/// "characteristics", "exact", "none".
std::string to_string(ReferenceSpec::Kind kind);

/// What was done for one output.
struct ReferenceReport {
  std::size_t untraced = 0;   // points whose value is not known: NaN in the result
  Vector first_untraced{};    // one of them
  std::string trouble;        // and why
  std::size_t rates = 0;      // evaluations of the velocity for one point, summed over all
  std::size_t exhausted = 0;  // points, among the untraced, that would take more steps than are allowed
};

class Reference {
 public:
  virtual ~Reference() = default;
  /// rho[i] = rho(x_i, time) on the lattice; NaN where it is not known, which the report counts. Times ascend from call
  /// to call.
  virtual ReferenceReport evaluate(double time, std::vector<double>& rho) = 0;
  /// The same at some of the lattice points alone, rho[i] at points[i]; at any time.
  virtual ReferenceReport evaluate_at(double time, const std::vector<std::size_t>& points,
                                      std::vector<double>& rho) const = 0;
};

}  // namespace gaussdrift
