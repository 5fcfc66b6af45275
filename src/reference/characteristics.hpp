// The exact density by characteristics: paths followed back to the initial density. method.md, section 7.
#pragma once

#include <cstddef>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <vector>

#include "field/density/density.hpp"
#include "field/velocity/velocity.hpp"
#include "gaussdrift/lattice.hpp"
#include "reference/reference.hpp"
#include "time/tableau.hpp"

namespace gaussdrift {

/// values[i] += g(x_i, t).
using ScalarRate = std::function<void(double t, const PointsView& x, double* values)>;

/// Beyond `low` or `high` along an axis there is no density.
struct Outflow {
  int axis = 0;
  double low = -std::numeric_limits<double>::infinity(), high = std::numeric_limits<double>::infinity();
};

/// Land: where there is no fluid.
struct NoFluid {
  std::function<bool(double t, const Vector& x)> at;
  /// Whether the straight way between two places of a path meets it.
  std::function<bool(double from, const Vector& a, double to, const Vector& b)> between;
  double from_there = std::numeric_limits<double>::quiet_NaN();  // the density on paths that come from there
};

struct CharacteristicsOptions {
  double tolerance = 1e-12;  // of a step: of the foot relative to the longest side of the lattice, and of the exponent
  bool smooth = true;        // false: u or g has kinks; the path of every point then takes steps of its own
  bool steady = false;       // u and g do not depend on t: each output goes on from the feet of the one before
  double end = 0;            // of the run; without `steady` no step is longer than a 32nd of it
  std::size_t most_steps = 10'000;          // from one output to the next (not steady: to the start), taken or rejected
  const time::Tableau* steps_by = nullptr;  // a method of fixed steps of length `step` instead, on any path
  double step = 0;
  int threads = 0;
  std::vector<Outflow> outflows{};    // there is no density beyond: paths that come from there bring 0
  std::optional<NoFluid> no_fluid{};  // the density there is NaN, and is not meant to be known
  // evaluate() follows every `ranks`-th block of points from this one on, and leaves 0 for the others.
  std::size_t rank = 0, ranks = 1;
};

/// rho(x, t) = rho_0(X(0)) exp(-int_0^t g(X(s), s) ds),  X' = u(X, s),  X(t) = x,  g = div u + u_0, traced backwards
/// from every point of the lattice. Values do not depend on the number of threads. The fields must outlive it. growth:
/// g; empty where it is 0.
std::unique_ptr<Reference> characteristics(const VelocityField& velocity, const InitialDensity& density,
                                           ScalarRate growth, const Lattice& lattice,
                                           const CharacteristicsOptions& options);

}  // namespace gaussdrift
