// Diffusion by a random walk, d_t rho + div(rho u) = div(D grad rho): every particle goes its own way by chance, weights
// and widths stay. What it draws follows from the seed, its id and the number of the step. docs/method.md, section 8.2.
#pragma once

#include <array>
#include <cstdint>

#include "effect/effect.hpp"
#include "field/scalar.hpp"
#include "particle/cutoff.hpp"

namespace gaussdrift {

class RandomWalk : public Effect {
 public:
  struct Options {
    Tensor diffusion{};                  // D, symmetric, no eigenvalue below 0; the unit matrix where a field has it
    const ScalarField* field = nullptr;  // D as a number of place and time; null: constant. It must outlive the effect
    std::uint64_t seed = 0;
    double particles_a_blob = 0;  // that share one at the start: 1 / (h^d int zeta_eps^2)
    int threads = 0;              // 0: all
  };
  explicit RandomWalk(const Options& options);

  std::string name() const override { return "diffusion"; }
  std::string describe() const override;
  Changes changes() const override { return {.position = true, .neighbours = true}; }
  std::string conserves() const override { return "every weight"; }

  bool acts_between_steps() const override { return true; }
  bool scatters() const override { return true; }
  void scatter(Particles& particles, const Scattering& part) override;

  /// Tells how large the noise of the density is.
  std::string warning() const override;
  Numbers numbers() const override;

 private:
  void add_coefficient(const Particles& particles, std::size_t first, const PointsView& x, double time,
                       double* values) const;

  Options options_;
  Tensor root_{};  // D = root root^T, lower triangular
};

}  // namespace gaussdrift
