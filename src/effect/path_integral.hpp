// Quantities that accumulate along the path of a particle, y_j' = f(X_j(t), y_j, t): exponents of weights and of volumes,
// weights that change into each other. The stepper integrates them with the stages of the path, so they have the path's
// order and cost one evaluation of f a stage.
#pragma once

#include <cstddef>
#include <string>

#include "gaussdrift/particles.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

class PathIntegral {
 public:
  virtual ~PathIntegral() = default;
  /// How many quantities there are: rows of Particles::path.
  virtual std::size_t rows() const { return 1; }
  /// rates[r * x.count + i] += y_r' of particle first + i, where it is at x_i and has gathered
  /// gathered[r * x.count + i]. Called for blocks of particles, from several threads.
  virtual void add_rates(double t, const Particles& particles, std::size_t first, const PointsView& x,
                         const double* gathered, double* rates) const = 0;
  /// "the rate of [effects.reaction]": names f in messages.
  virtual std::string quantity() const = 0;
};

/// One quantity whose rate depends on place and time alone: I_j' = f(X_j(t), t).
class PlainIntegral : public PathIntegral {
 public:
  /// rate[i] += f(x_i, t).
  virtual void add_rate(double t, const PointsView& x, double* rate) const = 0;
  void add_rates(double t, const Particles& /*particles*/, std::size_t /*first*/, const PointsView& x,
                 const double* /*gathered*/, double* rates) const final {
    add_rate(t, x, rates);
  }
};

/// How many rows all of them have.
template <class Integrals>
std::size_t rows_of(const Integrals& integrals) {
  std::size_t rows = 0;
  for (const auto* integral : integrals) rows += integral->rows();
  return rows;
}

}  // namespace gaussdrift
