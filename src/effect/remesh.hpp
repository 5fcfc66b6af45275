// Remeshing: weights go back to a fresh lattice when the particles have lost their overlap. Mass and the moments that
// the kernel keeps stay the same to rounding. docs/method.md, section 8.3.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "effect/effect.hpp"
#include "effect/lattice_ends.hpp"
#include "effect/node_sums.hpp"
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
    LatticeEnds ends{};                               // edges of the domain
  };
  /// The lattice is continued beyond the domain where particles have left it, unless the domain has an edge there.
  Remesh(const Lattice& lattice, const Options& options);
  /// The same where ranks share the particles. They do the rest together.
  Remesh(const Lattice& lattice, const Options& options, base::Communicator& ranks, RankAt rank_at);

  std::string name() const override { return "remesh"; }
  std::string describe() const override;
  Changes changes() const override { return {.position = true, .weight = true, .width = true, .particles = true}; }
  std::string conserves() const override;

  bool talks_to_ranks() const override { return true; }
  void placed(const Particles& /*particles*/) override { known_ = unknown; }
  bool acts_between_steps() const override { return true; }
  bool rearrange(Particles& particles, double time) override;
  Numbers numbers() const override;
  void pass_state(base::StateBytes& bytes, const Particles& particles) override;

  /// Puts the weights on the lattice now. What blobs have spread (Particles::spread) goes into the weights, and they
  /// start again with the widths of the case; a piecewise kernel leaves a small spread with the blobs. Throws
  /// NumericalError if the particles lie so scattered that the nodes need too much memory.
  void remesh(Particles& particles);

  /// The largest distance between particles that start as neighbours, in lattice spacings, of those with weight. Those
  /// beside a closed end are neighbours of their mirror images.
  double largest_stretch(const Particles& particles);

 private:
  using Pairs = std::vector<std::pair<std::size_t, std::size_t>>;
  static constexpr std::size_t unknown = std::numeric_limits<std::size_t>::max();

  template <class Alone>
  Pairs neighbours(const Particles& particles, const Alone& alone) const;
  double longest_to_image(const Particles& particles, double light) const;
  void find_neighbours(const Particles& particles);
  Particles met_by_others(const Particles& particles) const;
  Particles exchanged(int dimension, std::vector<base::Bytes> out) const;
  void share(const Particles& particles, std::size_t j, double spread, NodeWeights& axes) const;
  int owner(const NodeIndex& first_of_block) const;
  Particles felt_here(const Particles& particles, double spread) const;

  base::Communicator alone_;
  base::Communicator& ranks_;
  RankAt rank_at_;
  Nodes nodes_;
  Options options_;
  RemeshKernel kernel_;
  Pairs neighbours_;                    // particles of this rank on adjacent nodes
  std::vector<std::size_t> at_border_;  // particles whose neighbours are perhaps on other ranks
  std::size_t known_ = unknown;         // particles that these were found for
  std::int64_t steps_ = 0, remeshings_ = 0;
  double most_negative_ = 0;  // largest sum of negative weights after a remeshing, relative to sum |alpha|
  double most_dropped_ = 0;   // largest sum of |weights| left out, likewise
};

}  // namespace gaussdrift
