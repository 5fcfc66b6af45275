// The density rho_eps^h = sum_j alpha_j zeta_eps(x - X_j) on the evaluation lattice, by fgtd, to a tolerance relative
// to its own maximum. method.md, section 5.
#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"
#include "particle/cutoff.hpp"
#include "particle/tiles.hpp"

namespace gaussdrift {

/// A sum of derivatives D^alpha of the density: one is a component of the gradient, two or three are the Laplacian.
using DensityDerivatives = std::vector<std::array<int, max_dimension>>;

struct DensityOptions {
  double tolerance = 1e-8;                  // relative to max |rho| at that output
  std::string method = "auto";              // auto, or a method of fgtd by name
  std::optional<HermiteSpec> hermite = {};  // of the method `hermite`; they bound the error in place of the tolerance
  int threads = 0;                          // 0: all
  bool measure = true;                      // compare with `direct` on a sample of the grid
  std::optional<TileLimits> tiles = {};     // usual_tiles() where none are given
  /// Summed in the same pass, each to the tolerance relative to its own maximum.
  std::vector<DensityDerivatives> derivatives = {};

  /// The density and its derivatives.
  std::size_t quantities() const { return 1 + derivatives.size(); }
};

/// A number for the density, then one for each of its derivatives.
using OfQuantities = std::vector<double>;

/// The most that a quantity comes to anywhere, of two estimates.
void raise(OfQuantities& largest, const OfQuantities& other);

/// Has a quantity turned out much smaller on the grid than expected? Then a tolerance relative to what was expected is
/// too coarse.
bool is_too_coarse(const OfQuantities& found, const OfQuantities& expected);

/// What one evaluation did.
struct DensityReport {
  double requested_tolerance = 0;  // per term, asked of fgtd
  /// Bound on the error relative to max |rho|: above the tolerance only if that cannot be promised.
  double achievable = 0;
  double measured_error = 0;  // on the sample, relative to max |rho| on the grid
  std::size_t sample = 0;     // grid points compared
  double evaluate_seconds = 0;
  double measure_seconds = 0;
  std::string choice;  // what fgtd chose, one line a Gaussian width
  /// The same for the derivatives, where any were asked for: bound and measured error of the worst of them.
  double derivatives_achievable = 0, derivatives_error = 0;
  /// Where the density is summed as a whole: the derivatives on the lattice.
  std::vector<std::vector<double>> derivatives;
};

/// Fills in measured errors, relative to the maxima.
void tell_errors(const OfQuantities& errors, const OfQuantities& maxima, DensityReport& report);

/// The density of the particles on the lattice. Without particles it is 0. A large one is summed tile by tile, see
/// tiled_density.hpp.
DensityGrid evaluate_density(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                             const DensityOptions& options, DensityReport* report = nullptr);

/// The same in one sum, however large.
DensityGrid evaluate_at_once(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                             const DensityOptions& options, DensityReport* report = nullptr);

/// The tiles of a density.
Tiles tiles_of(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice, const DensityOptions& options,
               const Tiles::SumOverProcesses& sum = {});

/// What fgtd predicts for a density on one thread.
struct DensityWork {
  double seconds = 0;
  std::string method;  // that would do it
};

/// The work of evaluate_density(), predicted and not done.
DensityWork predict_density(const Particles& particles, const Cutoff& cutoff, const Lattice& lattice,
                            const DensityOptions& options);

/// A named method may take very long where `auto` does not, so its seconds are limited; those of `auto` if asked for.
inline bool limits_seconds(const EvaluateSpec& evaluate) {
  return evaluate.method != "auto" || evaluate.most_seconds > 0;
}

/// Refuses (InputError) work that is predicted to take longer than such a case allows. `fastest` gives the work of `auto`
/// and is called where the message needs it.
void check_seconds(const EvaluateSpec& evaluate, const DensityWork& work, int threads,
                   const std::function<DensityWork()>& fastest);

/// The density at some points, given as one array for each axis: the sum of all blobs, without approximation.
std::vector<double> sum_blobs(const Particles& particles, const Cutoff& cutoff, const PointsView& points, int threads);

}  // namespace gaussdrift
