// Diffusion by particle strength exchange, d_t rho + div(rho u) = div(D grad rho): what is on the right is an integral
// over neighbours, and its sum over the particles is a Gauss transform at the particles themselves. Weights change, blobs
// keep their width, and particles without weight surround those with weight as far as diffusion reaches in a step.
// docs/method.md, section 8.2.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <limits>
#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "base/folding.hpp"
#include "effect/effect.hpp"
#include "effect/lattice_ends.hpp"
#include "effect/nodes.hpp"
#include "field/scalar.hpp"
#include "field/velocity/velocity.hpp"
#include "particle/tiles.hpp"

namespace gaussdrift {

class ParticleExchange : public Effect, private PlainIntegral {
 public:
  struct Options {
    double coefficient = 0;              // D > 0; 1 where a field has it
    std::vector<double> of_tracers{};    // of named densities: which part of it each has; empty: there are none
    const ScalarField* field = nullptr;  // D as a number of place and time; null: constant. It must outlive the effect
    double end = 0;                      // until when a field counts
    double tolerance = 1e-6;  // particles with more than this part of the largest density are surrounded by others
    int threads = 0;          // 0: all
    std::size_t most_particles = std::size_t{1} << 24;  // with the halo, some 250 bytes each; beyond, an error
    LatticeEnds ends{};                                 // periodic and closed edges of the domain
    Folding folding{};                                  // the same edges, for places
    TileLimits tiles = {.particles = std::numeric_limits<std::int64_t>::max(),
                        .points = std::numeric_limits<std::int64_t>::max()};  // of what is summed at once
  };
  /// Carries particles from their nodes, where they stood at the last begin(), to the present, with their path
  /// integrals.
  using Follow = std::function<void(Particles& particles)>;

  /// The velocity must outlive the effect. Its divergence changes volumes: they are integrated along the paths unless
  /// the field is solenoidal by construction.
  ParticleExchange(const Lattice& lattice, double core_radius, const VelocityField& velocity, Follow follow,
                   const Options& options);
  /// The same where ranks share the particles. They do the rest together. Particles stand in the order of their ids.
  ParticleExchange(const Lattice& lattice, double core_radius, const VelocityField& velocity, Follow follow,
                   const Options& options, base::Communicator& ranks);

  std::string name() const override { return "diffusion"; }
  std::string describe() const override;
  Changes changes() const override { return {.weight = true, .particles = true}; }
  std::string conserves() const override { return "mass; the centroid to the tolerance of the sum"; }
  /// Heun's method exchanges the weights. It is stable up to this step: 2 / (1 / eps^2 max_i g_i (K g V)_i), g^2 = D.
  double stable_step() const override { return stable_step_; }

  void begin(Particles& particles, double time) override;
  const PathIntegral* path_integral() const override { return solenoidal_ ? nullptr : this; }
  void settle(Particles& particles, const double* integral, double time) override;
  bool acts_between_steps() const override { return true; }
  void exchange(Particles& particles, double time, double length) override;
  bool talks_to_ranks() const override { return true; }
  void placed(const Particles& /*particles*/) override { known_ = false; }
  Numbers numbers() const override;
  void pass_state(base::StateBytes& bytes, const Particles& particles) override;

 private:
  void add_rate(double t, const PointsView& x, double* rate) const override { velocity_.add_divergence(t, x, rate); }
  std::string quantity() const override { return "the divergence of the velocity"; }

  void find_nodes(const Particles& particles);
  void index_nodes(const Particles& particles);
  std::size_t meeting(std::int64_t id) const;
  std::vector<std::vector<std::int64_t>> exchanged(std::vector<std::vector<std::int64_t>> numbers) const;
  std::size_t count_of_all(const Particles& particles) const;

  void grow_halo(Particles& particles);
  std::vector<char> that_count(const Particles& particles) const;
  std::vector<std::vector<double>*> weights_of(Particles& particles) const;
  template <class Use>
  void for_each_neighbour(std::int64_t id, const Use& use) const;
  std::vector<std::size_t> edge(const Particles& particles, const std::vector<char>& counts);
  std::vector<char> count_elsewhere(const Particles& particles, const std::vector<char>& counts,
                                    const std::vector<std::pair<std::int64_t, std::size_t>>& asked) const;
  std::set<std::int64_t> missing_around(const Particles& particles, const std::vector<std::size_t>& at_edge,
                                        std::size_t count) const;
  std::set<std::int64_t> made_here(const std::set<std::int64_t>& missing);
  void add(const std::set<std::int64_t>& missing, Particles& particles);
  [[noreturn]] void refuse_so_many() const;

  template <int d>
  void exchange_in_dimension(Particles& particles, double time, double length);
  template <int d>
  double largest_rate(const Particles& particles, double time) const;
  Eigen::ArrayXd roots(const Particles& particles, double time) const;
  double largest(const Eigen::ArrayXd& numbers) const;
  std::pair<double, double> sums_of(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b) const;

  base::Communicator alone_;
  base::Communicator& ranks_;
  Nodes nodes_;
  double core_radius_;
  const VelocityField& velocity_;
  Follow follow_;
  Options options_;
  bool solenoidal_;
  std::int64_t halo_;  // lattice steps that the halo is wide
  double stable_step_ = 0;
  bool known_ = false;                                // what follows
  std::unordered_map<std::int64_t, std::size_t> at_;  // particle of this rank on a node
  std::vector<char> surrounded_;                      // particles of this rank whose halo has been made
  std::unordered_set<std::int64_t> there_are_;        // several ranks: particles of any rank on nodes that meet here
  std::size_t started_ = 0, most_ = 0;                // particles at the first begin(), and at most
};

}  // namespace gaussdrift
