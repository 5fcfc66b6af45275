// Vortex blobs: the density is a vorticity, weights are circulations, and the blobs move each other,
//   X_j' = u(X_j, t) + sum_k alpha_k (1 - exp(-r^2/w^2)) / (2 pi r^2) (-dy, dx),   (dx, dy) = X_j - X_k,
// the velocity whose vorticity is the density of Gaussian blobs of width w. docs/method.md, section 8.5.
#pragma once

#include "effect/drift.hpp"
#include "effect/effect.hpp"
#include "effect/pair_velocity.hpp"

namespace gaussdrift {

class Vortex : public Effect, private Drift {
 public:
  struct Options {
    double core_radius = 0;  // w at the start
    double spreading = 0;    // w^2 grows at this rate, 4 D with core spreading
    double cell = 1;         // area of a particle at the start
    double tolerance = 1e-6;
    int threads = 0;
    base::Communicator* ranks = nullptr;  // that share the particles; null: all are here
    Domain domain{};                      // images are beyond its periodic and closed edges
  };
  explicit Vortex(const Options& options)
      : options_(options), pairs_(options.tolerance, options.threads, options.ranks, options.domain) {}

  std::string name() const override { return "vortex"; }
  std::string describe() const override;
  Changes changes() const override { return {.position = true}; }
  std::string conserves() const override;
  /// A turn of the fastest vortex is 4 pi / vorticity; a step of 1 / vorticity is accurate with rk4.
  double stable_step() const override;

  void begin(Particles& particles, double time) override;
  const Drift* drift() const override { return this; }
  bool talks_to_ranks() const override { return options_.ranks != nullptr; }
  Numbers numbers() const override;
  void pass_state(base::StateBytes& bytes, const Particles& /*particles*/) override {
    bytes(largest_vorticity_, circulation_);
    pairs_.pass_state(bytes);
  }

 private:
  void add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const override;

  Options options_;
  PairVelocity pairs_;
  double largest_vorticity_ = 0, circulation_ = 0;
};

}  // namespace gaussdrift
