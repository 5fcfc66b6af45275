/// @file
/// What a run shows at each output time, and who looks at it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "gaussdrift/density_grid.hpp"
#include "gaussdrift/lattice_pieces.hpp"
#include "gaussdrift/norms.hpp"
#include "gaussdrift/particles.hpp"
#include "gaussdrift/points.hpp"
#include "gaussdrift/tracks.hpp"

namespace gaussdrift {

/// What has left the run for one reason, since the start.
struct Departed {
  std::string reason;           ///< "x_max" for that face of the domain
  std::uint64_t particles = 0;  ///< their number
  double mass = 0;              ///< the sum of the weights that they had then
};

/// Particles that have reached land and stay there.
struct Stopped {
  std::uint64_t particles = 0;  ///< their number
  double mass = 0;              ///< the sum of their weights
};

/// What there is of a named tracer.
struct TracerNumbers {
  std::string name;                  ///< as in the case
  double mass = 0;                   ///< the sum of its weights
  double minimum = 0;                ///< of its density on the grid
  double maximum = 0;                ///< of its density on the grid
  std::optional<double> released{};  ///< the sum of its weights that sources have released so far; only with sources
  /// What reactions have added to it so far; mass = mass at the start + released + reacted - left, but for rounding.
  std::optional<double> reacted{};
  std::optional<ErrorNorms> error{};  ///< only where the case gives its exact density
  std::optional<double> left{};       ///< of its weights, with what has left the run; only where particles can leave
};

/// Values of a field of the particles that a check asks for.
struct FieldNumbers {
  std::string name;          ///< as in output.fields
  double largest = 0;        ///< NaN where no particle has a value
  double mean = 0;           ///< over particles that have a value
  std::uint64_t values = 0;  ///< their number
};

/// Numbers of one output, a row of series.csv.
struct FrameNumbers {
  double mass = 0;     ///< sum_j alpha_j, the exact integral of rho_eps^h over all space
  double minimum = 0;  ///< of rho on the grid
  double maximum = 0;  ///< of rho on the grid
  Vector centroid{};   ///< sum_j alpha_j X_j / mass; NaN where positive and negative weights cancel
  /// Of the Gauss transform, measured on a sample of the grid against `direct`, relative to max |rho|.
  double transform_error = 0;
  double transform_tolerance = 0;  ///< per-term tolerance that was asked of fgtd
  double evaluate_seconds = 0;     ///< preparing and evaluating the transform
  double seconds = 0;              ///< since the run began, where this output is ready to be looked at
  /// Largest distance of particles that start as lattice neighbours, in spacings; 0: they are replaced.
  double stretch = 0;
  double weight = 0;                ///< sum_j |alpha_j|
  double outside = 0;               ///< part of sum |alpha_j| whose particles are outside the domain
  std::optional<ErrorNorms> error;  ///< only with a reference
  std::string no_norms;      ///< why they are NaN, for people: nothing is left to compare; empty: they are numbers
  std::size_t compared = 0;  ///< grid points that the norms are taken over; a sample if fewer than the grid has
  std::size_t untraced = 0;  ///< grid points where the reference is not known; the norms leave them out
  /// sum of the weights of the particles inside the domain; only where the case says what happens at its edges or at land
  std::optional<double> inside{};
  /// What has left the run so far, for each reason that there may be, in a fixed order; empty: nothing can leave.
  std::vector<Departed> left{};
  /// The sum of the weights that sources have released so far; only with sources.
  /// mass = mass at the start + released - what has left - decayed, but for rounding.
  std::optional<double> released{};
  /// What weights have lost along the paths so far, by a reaction; only with sources.
  std::optional<double> decayed{};
  /// What lies on land; only where domain.coast is "stop".
  std::optional<Stopped> stopped{};
  std::vector<TracerNumbers> tracers{};  ///< in the order of the case; empty: its densities have no names
  std::vector<FieldNumbers> fields{};    ///< those that checks name; others are not counted
};

/// One output. What it points at belongs to the run and stays as it is until the observer returns.
struct Frame {
  int index = 0;                         ///< 0 for the first output
  double time = 0;                       ///< that the clock of the case shows
  double elapsed = 0;                    ///< since the run began, as in `OutputSpec::times`
  const Particles* particles = nullptr;  ///< never null; see Observer::needs_particles()
  /// u(X_j, t) [j][dimension]; only if files that the case names need it, else null
  const std::vector<double>* velocity = nullptr;
  /// What the case names of the particles in output.fields, [j][component]; null: nothing
  const std::vector<FieldOnGrid>* particle_fields = nullptr;
  /// On all of the evaluation lattice, or on every k-th point of it where there are pieces; never null.
  const DensityGrid* density = nullptr;
  /// rho at the points of the density, NaN where not known; null without a reference and where a sample is compared
  const std::vector<double>* exact = nullptr;
  FrameNumbers numbers;  ///< of this output
  /// The pieces of a density that is too large to be held as a whole; null: there is one, and it is `density`.
  const LatticePieces* pieces = nullptr;
  const Lattice* lattice = nullptr;  ///< with pieces: of all of them
  std::size_t every = 1;             ///< k
  bool pieces_have_exact = false;    ///< whether they come with the exact density
  /// Name and components of the fields that the pieces have; with pieces `density` has none.
  std::vector<std::pair<std::string, int>> piece_fields{};
  std::size_t particle_pieces = 1;  ///< more: particles come in so many pieces too
};

/// A piece of a density that is too large to be held as a whole (`evaluate.piece_points`).
struct DensityPiece {
  std::size_t number = 0;  ///< from 0
  LatticeBox box;          ///< the points that it shows, with the layers that the next pieces have too
  const std::vector<double>* rho = nullptr;          ///< at its points, first axis fastest; never null
  const std::vector<double>* exact = nullptr;        ///< the same of the exact density; null where it is not known
  const std::vector<FieldOnGrid>* fields = nullptr;  ///< what the case names beside it, at its points; null: nothing
};

/// A piece of particles that are too many for one file (`output.piece_particles`): neighbours in the order of ids.
struct ParticlePiece {
  std::size_t number = 0;                            ///< from 0
  const Particles* particles = nullptr;              ///< places, weights and ids, which ascend; never null
  const std::vector<double>* velocity = nullptr;     ///< there, [j][dimension]; never null
  const std::vector<FieldOnGrid>* fields = nullptr;  ///< Frame::particle_fields of these particles
};

/// Looks at the frames of a run. What it throws ends the run, and comes out of Simulation::run().
class Observer {
 public:
  virtual ~Observer() = default;
  /// Names the stage in RunSummary::stages.
  virtual std::string name() const = 0;
  /// Whether frame() looks at the particles of the output at this elapsed time. Where several ranks share a run, particles and
  /// their velocities are brought together for it alone; else the frame has those of rank 0.
  virtual bool needs_particles(double /*elapsed*/) const { return true; }
  /// Whether it looks at particle_piece(): then needs_particles() is not asked where particles come in pieces.
  virtual bool takes_particle_pieces() const { return false; }
  /// Called once for each output time, in their order, on the thread of run().
  virtual void frame(const Frame& frame) = 0;
  /// Before frame(), if the density comes in pieces: called for each piece on the rank that has it, so that observers
  /// that look at pieces are added on all ranks. Of the frame only index, time, pieces, lattice and every are there.
  /// All pieces of an output may come twice: the second ones, with a finer tolerance, replace the first.
  virtual void piece(const Frame& /*frame*/, const DensityPiece& /*piece*/) {}
  /// The same of particles, whose pieces come once, before frame(). Of the frame only index, time and particle_pieces are
  /// there.
  virtual void particle_piece(const Frame& /*frame*/, const ParticlePiece& /*piece*/) {}
  /// Some more of the tracks, `output.tracks`: all that were looked at together, and those that have ended since. On
  /// rank 0.
  virtual void tracks(const TrackSamples& /*samples*/) {}
  /// Called at each frame of an animation, `output.animation`, on rank 0. Of the frame only index, which counts these
  /// frames, time, elapsed and density are there. At the time of an output it comes before frame().
  virtual void moment(const Frame& /*frame*/) {}
  /// Bytes that restore() needs, beside what is known of the outputs.
  virtual std::string state() const { return {}; }
  /// The run goes on after these outputs, by the times that the clock showed, of an earlier process: files that hold all of them are made again. `state` is
  /// what state() said then.
  virtual void restore(const std::vector<std::pair<double, FrameNumbers>>& /*frames*/, const std::string& /*state*/) {}
  /// Called once after the last frame; not if the run ends before.
  virtual void finish() {}
};

}  // namespace gaussdrift
