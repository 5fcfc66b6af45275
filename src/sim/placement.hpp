// Which rank carries which particles of a run, and what all of them come to together.
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/placing.hpp"
#include "particle/tiles.hpp"

namespace gaussdrift {

class Placement {
 public:
  explicit Placement(base::Communicator& ranks) : ranks_(ranks) {}

  base::Communicator& ranks() const { return ranks_; }
  /// Rank 0 writes, draws and compares.
  bool is_first() const { return ranks_.rank() == 0; }

  /// New tiles for where the particles are now, and every particle on the rank that has its tile. `work`: seconds that a
  /// tile takes until the next placing.
  void renew(Particles& particles, Tiles tiles, const std::function<double(const Tile& tile)>& work);

  const Tiles& tiles() const { return *tiles_; }
  /// Of all ranks, when they were placed; 0 before.
  std::size_t particle_count() const;
  const std::vector<int>& owner() const { return owner_; }
  std::vector<char> owned() const;
  int owner_of(const Vector& place) const { return owner_[tiles_->of(place)]; }
  /// One tile: rank 0 has all particles.
  bool one_tile() const { return tiles_->list().size() == 1; }

  /// Sums over the particles of all ranks: fill(j, addends) sets `count` numbers of a particle. With one tile it is a
  /// plain sum in the order of ids, with several an exact one: neither depends on the number of ranks.
  std::vector<double> sums(const Particles& particles, std::size_t count, int threads,
                           const std::function<void(std::size_t j, double* addends)>& fill) const;

  double max(double number) const;

  /// Up to `most` places, spread over all particles. All ranks get them.
  Particles sample(const Particles& particles, std::size_t most) const;

 private:
  base::Communicator& ranks_;
  std::optional<Tiles> tiles_;
  std::vector<int> owner_;
};

}  // namespace gaussdrift
