#include "sim/particle_pieces.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/piece_writers.hpp"
#include "particle/placing.hpp"
#include "particle/subset.hpp"

namespace gaussdrift {

namespace {

// Numbers of particles in the order of their ids.
class ById {
 public:
  explicit ById(const Particles& particles) : id_(particles.id) {
    if (std::is_sorted(id_.begin(), id_.end())) return;  // as nearly always
    order_.resize(id_.size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return id_[a] != id_[b] ? id_[a] < id_[b] : a < b; });
  }
  std::size_t number(std::size_t at) const { return order_.empty() ? at : order_[at]; }
  /// How many have an id below this.
  std::size_t below(std::int64_t id) const {
    std::size_t low = 0, high = id_.size();
    while (low < high) {
      const std::size_t middle = low + (high - low) / 2;
      if (id_[number(middle)] < id)
        low = middle + 1;
      else
        high = middle;
    }
    return low;
  }

 private:
  const std::vector<std::int64_t>& id_;
  std::vector<std::size_t> order_;  // empty: as they are
};

// Ids where the pieces begin, by halving intervals: the smallest below which enough particles lie.
std::vector<std::int64_t> first_ids(const Particles& particles, const ById& by_id, std::size_t pieces,
                                    base::Communicator& ranks) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  std::vector<std::int64_t> ends{most, -most, 0};  // smallest id, and the largest; number of particles
  for (const std::int64_t id : particles.id) ends[0] = std::min(ends[0], id), ends[1] = std::max(ends[1], id);
  ends[2] = static_cast<std::int64_t>(particles.size());
  ends[0] = -ends[0];
  ranks.max(std::span(ends).first(2));
  ranks.sum(std::span(ends).subspan(2));
  const auto total = static_cast<std::size_t>(ends[2]);
  std::vector<std::int64_t> low(pieces - 1, -ends[0]), high(pieces - 1, ends[1]), middle(pieces - 1), count(pieces - 1);
  const auto open = [&] { return !std::equal(low.begin(), low.end(), high.begin()); };
  while (open()) {
    for (std::size_t p = 0; p + 1 < pieces; ++p) {
      middle[p] = low[p] + (high[p] - low[p]) / 2;
      count[p] = static_cast<std::int64_t>(by_id.below(middle[p] + 1));
    }
    ranks.sum(count);
    for (std::size_t p = 0; p + 1 < pieces; ++p) {
      // With `middle` itself, as many as all pieces up to this one have: the next one begins behind it.
      const std::size_t before = (p + 1) * (total / pieces) + (p + 1) * (total % pieces) / pieces;
      if (static_cast<std::size_t>(count[p]) > before)
        high[p] = middle[p];
      else
        low[p] = std::min(high[p], middle[p] + 1);
    }
  }
  return low;
}

// Velocities travel as integrals.
Particles with_velocity(const Particles& particles, const std::vector<double>& velocity,
                        const std::vector<std::size_t>& chosen) {
  Particles some = subset(particles, chosen);
  const auto dimension = static_cast<std::size_t>(some.dimension);
  some.path.assign(dimension, std::vector<double>(chosen.size()));
  for (std::size_t i = 0; i < chosen.size(); ++i)
    for (std::size_t k = 0; k < dimension; ++k) some.path[k][i] = velocity[chosen[i] * dimension + k];
  return some;
}

std::vector<double> velocity_of(Particles& particles) {
  const auto dimension = static_cast<std::size_t>(particles.dimension);
  std::vector<double> velocity(particles.size() * dimension);
  for (std::size_t k = 0; k < dimension; ++k)
    for (std::size_t i = 0; i < particles.size(); ++i) velocity[i * dimension + k] = particles.path[k][i];
  particles.path.clear();
  return velocity;
}

}  // namespace

std::size_t pieces_of_particles(std::size_t count, double most) {
  return std::max<std::size_t>(1, static_cast<std::size_t>(std::ceil(static_cast<double>(count) / most)));
}

void hand_out_particles(const Particles& particles, const std::vector<double>& velocity, std::size_t pieces,
                        base::Communicator& ranks, const std::function<void(const ParticlePiece&)>& receive) {
  const ById by_id(particles);
  const std::vector<std::int64_t> firsts = first_ids(particles, by_id, pieces, ranks);
  const auto begin = [&](std::size_t piece) {
    return piece == 0 ? 0 : piece == pieces ? particles.size() : by_id.below(firsts[piece - 1]);
  };
  for (std::size_t round = 0; round < base::rounds_of_pieces(pieces, ranks.size()); ++round) {
    std::vector<base::Bytes> out(static_cast<std::size_t>(ranks.size()));
    ranks.agree_on([&] {
      for (int rank = 0; rank < ranks.size(); ++rank) {
        const std::size_t piece = base::piece_of_round(round, rank, pieces, ranks.size());
        if (piece == pieces) continue;
        std::vector<std::size_t> chosen;
        for (std::size_t at = begin(piece), end = begin(piece + 1); at < end; ++at) chosen.push_back(by_id.number(at));
        const Particles some = with_velocity(particles, velocity, chosen);
        std::iota(chosen.begin(), chosen.end(), std::size_t{0});
        out[static_cast<std::size_t>(rank)] = pack(some, chosen);
      }
    });
    std::vector<base::Bytes> in = ranks.exchange(std::move(out));
    ranks.agree_on([&] {
      const std::size_t piece = base::piece_of_round(round, ranks.rank(), pieces, ranks.size());
      if (piece == pieces) return;
      Particles own;
      own.dimension = particles.dimension;
      own.path.resize(static_cast<std::size_t>(own.dimension));
      for (base::Bytes& bytes : in) unpack(bytes, own), bytes = {};
      sort_by_id(own);
      const std::vector<double> of_own = velocity_of(own);
      receive({piece, &own, &of_own});
    });
  }
}

}  // namespace gaussdrift
