// Gauss transforms at the particles themselves, tile by tile, also where ranks share the particles.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <fgtd/fgtd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "base/folding.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/tiles.hpp"

namespace gaussdrift {

/// sum_j exp(-|X_i - X_j|^2 / width^2) w_j at the particles i, over particles j and their images beyond edges. Sources of a tile stand in the order of their ids, so bits
/// do not depend on the ranks. All ranks call everything together.
template <int d>
class ScatteredSums {
 public:
  /// `particles`: those of this rank, in the order of their ids. They and what they have must stay as they are.
  /// The tiles are parts of `lattice` and of all that lies beyond its rim. `what` is summed, for messages.
  ScatteredSums(std::string what, const Particles& particles, const Lattice& lattice, double width,
                const TileLimits& limits, const fgtd::Options& options, base::Communicator& ranks,
                const Folding& folding = {});
  ScatteredSums(const ScatteredSums&) = delete;
  ScatteredSums& operator=(const ScatteredSums&) = delete;

  /// A row of weights for each particle of this rank; the sums likewise. Throws NumericalError if they cannot be summed.
  Eigen::MatrixXd of(const Eigen::MatrixXd& weights);

 private:
  struct TileOfSum {
    std::vector<std::size_t> sources, targets;  // particles, by number among those that came here
    std::optional<fgtd::Plan<d>> plan;
  };

  void send(const std::vector<int>& owner);
  Eigen::MatrixXd to_owners(const Eigen::MatrixXd& weights) const;
  Eigen::MatrixXd from_owners(const Eigen::MatrixXd& sums, std::size_t particles) const;
  fgtd::Points<d> points(const std::vector<std::size_t>& chosen) const;

  std::string what_;
  base::Communicator& ranks_;
  double width_;
  fgtd::Options options_;
  std::size_t count_;            // particles of this rank
  std::vector<std::size_t> of_;  // the particle that each of images_ is an image of; empty: there are no images
  Particles images_;             // the particles and their images, if there are any
  const Particles* all_;         // these, or the particles
  Tiles tiles_;
  // Several ranks: which of all_ went to which rank, with which of them it sums; and how many came.
  std::vector<std::vector<std::size_t>> sent_, summed_by_;
  std::vector<std::vector<std::size_t>> came_, sums_for_;  // numbers of those from each rank, and of those summed here
  Particles arrived_;
  const Particles* here_;  // all that count in the tiles of this rank
  std::vector<TileOfSum> own_;
};

}  // namespace gaussdrift
