// Diffusion by particle strength exchange [DM89]: weights flow between neighbours,
//   alpha_j' = 4 D / eps^2 sum_k (v_j alpha_k - v_k alpha_j) G_eps(X_j - X_k),   G_eps Gaussian of radius eps, v
//   volumes,
// which is D Laplacian rho to order eps^2 and follows a flow that strains, since it sees the particles where they are.
// Particles of weight 0 around the density, the halo, receive what diffuses out of it. docs/method.md, section 8.2.
#pragma once

#include "base/lattice.hpp"
#include "effect/effect.hpp"
#include "field/velocity.hpp"

namespace gaussdrift {

class ParticleExchange : public Effect, private PathIntegral {
 public:
  struct Options {
    double coefficient = 0;  // D > 0
    double core_radius = 0;  // eps
    Lattice lattice;         // on which particles start
    double end = 0;          // of the run
    double halo = 0;         // width of the halo; 0: 7 sqrt(2 D end + eps^2/2), beyond which lies next to nothing
    int threads = 0;         // 0: all
  };
  /// The velocity must outlive the effect.
  ParticleExchange(const VelocityField& velocity, const Options& options) : velocity_(velocity), options_(options) {}

  std::string name() const override { return "diffusion"; }
  std::string describe() const override;
  Changes changes() const override { return {.weight = true, .particles = true}; }
  std::string conserves() const override { return "mass, to the tolerance 1e-10 of its Gauss transforms"; }
  /// eps^2 / (2 D m): Heun's method on the real axis, whose rates reach 4 D / eps^2 m with m the largest sum_k v_k
  /// G_eps.
  double stable_step() const override { return stable_step_; }

  /// Surrounds the particles with the halo. Throws InputError if that takes more than 1e8 particles, or if another
  /// effect has replaced the particles since.
  void begin(Particles& particles, double time) override;

  const PathIntegral* path_integral() const override { return velocity_.is_solenoidal() ? nullptr : this; }
  /// v_j grows by the exponential of the integral of div u.
  void settle(Particles& particles, const double* integral, double time) override;

  bool acts_between_steps() const override { return true; }
  /// One step of Heun's method. Throws NumericalError if more than 1e-6 of the weight has reached the edge of the halo.
  void exchange(Particles& particles, double time, double length) override;

  Numbers numbers() const override;

 private:
  void add_rate(double t, const PointsView& x, double* rate) const override { velocity_.add_divergence(t, x, rate); }
  std::string quantity() const override { return "the divergence of the velocity"; }

  const VelocityField& velocity_;
  Options options_;
  double stable_step_ = 0;
  std::size_t added_ = 0;          // particles of the halo
  std::vector<std::size_t> edge_;  // particles outside all others: weight that reaches them would be held back
  double at_edge_ = 0;             // the largest share of the weight seen there
};

}  // namespace gaussdrift
