// The exact density of a scene, to compare rho_eps^h with: by characteristics, or by a formula. method.md, section 7.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/lattice.hpp"
#include "expression/expression.hpp"
#include "field/density.hpp"
#include "field/velocity.hpp"
#include "gaussdrift/case.hpp"
#include "sim/frame.hpp"
#include "time/tableau.hpp"

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

/// values[i] += g(x_i, t).
using ScalarRate = std::function<void(double t, const PointsView& x, double* values)>;

struct CharacteristicsOptions {
  double tolerance = 1e-12;  // of a step: of the foot relative to the longest side of the lattice, and of the exponent
  bool smooth = true;        // false: u or g has kinks; the path of every point then takes steps of its own
  bool steady = false;       // u and g do not depend on t: each output goes on from the feet of the one before
  double end = 0;            // of the run; without `steady` no step is longer than a 32nd of it
  std::size_t most_steps = 10'000;          // from one output to the next (not steady: to the start), taken or rejected
  const time::Tableau* steps_by = nullptr;  // a method of fixed steps of length `step` instead, on any path
  double step = 0;
  int threads = 0;
};

/// rho(x, t) = rho_0(X(0)) exp(-int_0^t g(X(s), s) ds),  X' = u(X, s),  X(t) = x,  g = div u + u_0, traced backwards
/// from every point of the lattice. Values do not depend on the number of threads. The fields must outlive it. growth:
/// g; empty where it is 0.
std::unique_ptr<Reference> characteristics(const VelocityField& velocity, const InitialDensity& density,
                                           ScalarRate growth, const Lattice& lattice,
                                           const CharacteristicsOptions& options);

/// rho as an expression in x, y, (z,) t and the params. Throws ExpressionError.
std::unique_ptr<Reference> formula(const std::string& rho, const std::vector<std::pair<std::string, double>>& params,
                                   const Lattice& lattice);

/// Some points of a lattice that stand for all of them.
struct GridSample {
  std::vector<std::size_t> points;
  std::vector<double> weight;  // how many points of the lattice each stands for; 0: for the largest error alone
};

/// About `count` points. Half of them are points where |rho| is at least a millionth of its largest value, half are
/// others. Each half is spread evenly over its points. The neighbourhood of the largest value is added; it counts for
/// the largest error alone. All points if there are not more than `count`.
GridSample sample_of_grid(const Lattice& lattice, const std::vector<double>& rho, std::size_t count);

/// Norms of rho - exact over a sample; exact[i] at sample.points[i]. See compare() below.
ErrorNorms compare(const std::vector<double>& rho, const GridSample& sample, const std::vector<double>& exact);

/// Norms of rho - exact over the lattice points where exact is a number, each divided by that of exact; NaN where exact
/// is 0 everywhere. Sums in the order of the points.
ErrorNorms compare(const std::vector<double>& rho, const std::vector<double>& exact);

}  // namespace gaussdrift
