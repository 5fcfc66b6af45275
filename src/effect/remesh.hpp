// Remeshing: weights go back to a fresh lattice when the particles have lost their overlap. Mass and the moments that
// the kernel keeps stay the same to rounding. docs/method.md, section 8.3.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "effect/effect.hpp"
#include "effect/nodes.hpp"
#include "effect/remesh_kernel.hpp"

namespace gaussdrift {

class Remesh : public Effect {
 public:
  struct Options {
    int every = 0;         // steps between two remeshings; 0: as `stretch` says
    double stretch = 1.5;  // whenever particles that were neighbours are farther apart than so many spacings
    std::string kernel{remesh_kernels().front().name};
    double tolerance = 1e-9;  // nodes with less than this part of the largest |weight| are left out
    std::size_t memory_limit = std::size_t{4} << 30;  // bytes for the nodes touched
  };
  /// The lattice is continued beyond the domain where particles have left it.
  Remesh(const Lattice& lattice, const Options& options);

  std::string name() const override { return "remesh"; }
  std::string describe() const override;
  Changes changes() const override { return {.position = true, .weight = true, .width = true, .particles = true}; }
  std::string conserves() const override;

  bool acts_between_steps() const override { return true; }
  bool rearrange(Particles& particles, double time) override;
  Numbers numbers() const override;
  void pass_state(base::StateBytes& bytes, const Particles& particles) override;

  /// Puts the weights on the lattice now. What blobs have spread (Particles::spread) goes into the weights, and they
  /// start again with the widths of the case; a piecewise kernel leaves a small spread with the blobs. Throws
  /// NumericalError if the particles lie so scattered that the nodes need too much memory.
  void remesh(Particles& particles);

  /// The largest distance between particles that start as neighbours, in lattice spacings, of those with weight.
  double largest_stretch(const Particles& particles);

 private:
  void find_neighbours(const Particles& particles);

  Nodes nodes_;
  Options options_;
  RemeshKernel kernel_;
  std::vector<std::pair<std::size_t, std::size_t>> neighbours_;  // pairs of particles on adjacent nodes
  std::size_t known_ = 0;                                        // particles that neighbours_ was made for
  std::int64_t steps_ = 0, remeshings_ = 0;
  double most_negative_ = 0;  // largest sum of negative weights after a remeshing, relative to sum |alpha|
  double most_dropped_ = 0;   // largest sum of |weights| left out, likewise
};

}  // namespace gaussdrift
