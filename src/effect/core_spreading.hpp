// Diffusion by core spreading, d_t rho + div(rho u) = div(D grad rho): every blob is itself a solution of the heat
// equation. The square of each Gaussian width grows by 4 D t; weights and paths stay. With a matrix D blobs become
// ellipses along its axes. Exact where the flow only carries, and, where D is the same along all axes, turns. Where it
// strains, blobs keep their shape although they should be stretched; [effects.remesh] cures that for round ones by putting
// their spread into the weights. docs/method.md, section 8.2.
#pragma once

#include "effect/effect.hpp"
#include "field/velocity/velocity.hpp"
#include "particle/cutoff.hpp"

namespace gaussdrift {

class CoreSpreading : public Effect {
 public:
  /// D is symmetric with a positive largest eigenvalue and none below 0. The velocity, whose strain is sampled by differences over `distance` at times from 0 to `end`, must outlive
  /// the effect. Throws InputError if 4 D end is too large for a number.
  /// `renewed`: another effect of the case replaces the blobs from time to time.
  CoreSpreading(const Tensor& diffusivity, int dimension, const VelocityField& velocity, double end, double distance,
                bool renewed = false);

  std::string name() const override { return "diffusion"; }
  std::string describe() const override;
  Changes changes() const override { return {.width = true}; }
  std::string conserves() const override { return "every weight"; }

  void look_at(const Particles& sample) override;
  void begin(Particles& particles, double time) override;
  void land(Particles& particles, double time) override;

  /// Tells a strain that stretches fluid by more than a tenth over the run, or while blobs spread before they are renewed.
  std::string warning() const override;
  Numbers numbers() const override;
  void pass_state(base::StateBytes& bytes, const Particles& /*particles*/) override { bytes(since_); }

 private:
  bool is_even() const { return least_ == coefficient_; }

  Tensor diffusivity_;
  int dimension_;
  double coefficient_, least_;  // the largest eigenvalue and the smallest
  double end_, distance_;
  bool renewed_;
  double longest_ = 0;  // that blobs have spread before they were renewed
  double since_ = 0;    // blobs had the widths of the case at this time
  const VelocityField& velocity_;
  // The largest rate at which the flow changes lengths, of those sampled; with a matrix D, parts of it.
  double strain_ = 0;
};

}  // namespace gaussdrift
