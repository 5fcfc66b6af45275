// Charged particles that repel each other and drift with the field,
//   X_j' = u(X_j, t) + mobility E(X_j),   E = sum_k q_k (X_j - X_k) / r^d   (d = 2, 3; no unit has a factor 4 pi),
// where the charge is the weight or has a density of its own. In 2D the charges are blobs, a factor 1 -
// exp(-r^2/eps^2); in 3D they are points. docs/method.md, section 8.4.
#pragma once

#include <functional>
#include <vector>

#include "effect/drift.hpp"
#include "effect/effect.hpp"
#include "effect/pair_velocity.hpp"

namespace gaussdrift {

class Charge : public Effect, private Drift {
 public:
  struct Options {
    double mobility = 1;
    double core_radius = 0;  // eps at the start, 2D
    double spreading = 0;    // eps^2 grows at this rate, 4 D with core spreading
    double cell = 1;         // volume of a particle at the start
    double tolerance = 1e-6;
    int dimension = 2;
    int threads = 0;
    base::Communicator* ranks = nullptr;  // that share the particles; null: all are here
    Domain domain{};                      // images are beyond its periodic and closed edges
    /// Charges of particles at the start, from the nodes of the lattice that they started on; null: their weights, at all
    /// times.
    std::function<std::vector<double>(const Particles&)> own{};
    std::string written{};  // the density of those, for people
  };
  explicit Charge(Options options)
      : options_(std::move(options)), pairs_(options_.tolerance, options_.threads, options_.ranks, options_.domain) {}

  std::string name() const override { return "charge"; }
  std::string describe() const override;
  Changes changes() const override { return {.position = true}; }
  std::string conserves() const override;
  /// Within 1 / (mobility div E) the density changes by its own size.
  double stable_step() const override;
  std::string warning() const override;

  void begin(Particles& particles, double time) override;
  const Drift* drift() const override { return this; }
  bool talks_to_ranks() const override { return options_.ranks != nullptr; }
  void placed(const Particles& particles) override;
  Numbers numbers() const override;
  /// Charges of their own follow from the particles at the start.
  void pass_state(base::StateBytes& bytes, const Particles& /*particles*/) override {
    bytes(total_, largest_rate_);
    pairs_.pass_state(bytes);
  }

 private:
  void add(double t, const Particles& particles, const PointsView& x, const VectorsView& u) const override;
  const std::vector<double>& charges_of(const Particles& particles) const {
    return options_.own ? own_ : particles.alpha;
  }

  Options options_;
  PairVelocity pairs_;
  std::vector<double> own_;
  double total_ = 0, largest_rate_ = 0;
};

}  // namespace gaussdrift
