// What a run shows to its observers (write, render, series): one frame per output time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "base/density_grid.hpp"
#include "base/points.hpp"
#include "particle/particles.hpp"
#include "reference/norms.hpp"

namespace gaussdrift {

/// Numbers of one output, a row of series.csv.
struct FrameNumbers {
  double mass = 0;     // sum_j alpha_j, the exact integral of rho_eps^h over all space
  double minimum = 0;  // of rho on the grid
  double maximum = 0;
  Vector centroid{};  // sum_j alpha_j X_j / mass
  /// Of the Gauss transform, measured on a sample of the grid against `direct`, relative to max |rho|.
  double transform_error = 0;
  double transform_tolerance = 0;  // per-term tolerance that was asked of fgtd
  double evaluate_seconds = 0;     // preparing and evaluating the transform
  /// Largest distance of particles that start as lattice neighbours, in spacings; 0: they are replaced.
  double stretch = 0;
  double weight = 0;                // sum_j |alpha_j|
  double outside = 0;               // part of sum |alpha_j| whose particles are outside the domain
  std::optional<ErrorNorms> error;  // only with a reference
  std::string no_norms;             // why they are NaN, for people: nothing is left to compare; empty: they are numbers
  std::size_t compared = 0;         // grid points that the norms are taken over; a sample if fewer than the grid has
  std::size_t untraced = 0;         // grid points where the reference is not known; the norms leave them out
};

struct Frame {
  int index = 0;
  double time = 0;
  const Particles* particles = nullptr;
  /// u(X_j, t) [j][dimension]; only if files that are written need it, else null
  const std::vector<double>* velocity = nullptr;
  const DensityGrid* density = nullptr;
  /// rho at the points of the density, NaN where not known; null without a reference and where a sample is compared
  const std::vector<double>* exact = nullptr;
  FrameNumbers numbers;
};

class Observer {
 public:
  virtual ~Observer() = default;
  virtual std::string name() const = 0;  // names the stage in summary.json
  virtual void frame(const Frame& frame) = 0;
  virtual void finish() {}
};

}  // namespace gaussdrift
