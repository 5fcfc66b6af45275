// Sums of farfield over all particles, as the effects charge and vortex need them: a plan for each set of positions.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "base/communicator.hpp"
#include "base/state_bytes.hpp"
#include "farfield/farfield.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// The ranks of a run as farfield wants them.
class FarfieldRanks : public farfield::Ranks {
 public:
  explicit FarfieldRanks(base::Communicator& ranks) : ranks_(ranks) {}
  int rank() const override { return ranks_.rank(); }
  int size() const override { return ranks_.size(); }
  std::vector<Bytes> exchange(std::vector<Bytes> out) override {
    agree_to_go_on();
    return ranks_.exchange(std::move(out));
  }
  void sum(std::span<std::int64_t> numbers) override {
    agree_to_go_on();
    ranks_.sum(numbers);
  }
  void max(std::span<double> numbers) override {
    agree_to_go_on();
    ranks_.max(numbers);
  }
  /// Before a sum.
  void begin() { failed_together_ = false; }
  /// Whether all ranks have failed together since then, here.
  bool failed_together() const { return failed_together_; }

 private:
  // Each call begins with an agreement. A rank whose part of a sum fails or is abandoned between two calls agrees on that
  // instead of its next call, and the others learn of it in theirs.
  void agree_to_go_on() {
    try {
      ranks_.agree(nullptr);
    } catch (...) {
      failed_together_ = true;
      throw;
    }
  }

  base::Communicator& ranks_;
  bool failed_together_ = false;
};

class PairVelocity {
 public:
  /// threads: 0 for all. tolerance: as the promise of farfield has it. ranks: that share the particles; null: all are
  /// here. All of them call the functions together, and agree on errors. domain: whose edges have images beyond them.
  /// Throws InputError if there are such edges and several ranks.
  PairVelocity(double tolerance, int threads, base::Communicator* ranks = nullptr, const Domain& domain = {});

  /// Velocity at x of vortex blobs of core radius `core` and circulations `weights`: 2 x particles. On several ranks sums
  /// have the order of ids. mirrored: the circulations of images in closed edges.
  farfield::Points<2> vortices(const PointsView& x, const std::vector<std::int64_t>& ids,
                               const std::vector<double>& weights, double core,
                               farfield::MirrorImages mirrored = farfield::MirrorImages::opposite) const;
  /// Field of point charges: 3 x particles.
  farfield::Points<3> charges(const PointsView& x, const std::vector<std::int64_t>& ids,
                              const std::vector<double>& weights) const;

  /// Measured: what a plan and its evaluation hold a particle.
  static double bytes_of_particle(int dimension) { return dimension == 3 ? 300 : 200; }

  /// See Effect::pass_state().
  void pass_state(base::StateBytes& bytes) { bytes(evaluations_); }

  std::size_t evaluations() const { return evaluations_; }
  const farfield::Choice& last_choice() const { return choice_; }

 private:
  template <int d>
  farfield::Points<d> field_of(farfield::Kernel kernel, const PointsView& x, const std::vector<std::int64_t>& ids,
                               const std::vector<double>& weights, const farfield::Options& options,
                               std::unique_ptr<farfield::Plan<d>>& plan) const;

  double tolerance_;
  int threads_;
  base::Communicator* ranks_;  // null: one rank
  std::array<farfield::Axis, 3> axes_;
  std::unique_ptr<FarfieldRanks> farfield_ranks_;
  // The plan of the last evaluation. It is kept because plans share their tables as long as one of them lives.
  mutable std::unique_ptr<farfield::Plan<2>> plane_;
  mutable std::unique_ptr<farfield::Plan<3>> space_;
  mutable farfield::Choice choice_{};
  mutable std::size_t evaluations_ = 0;
};

}  // namespace gaussdrift
