#include "particle/pieces_by_id.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>
#include <span>
#include <utility>

#include "base/piece_writers.hpp"
#include "particle/placing.hpp"

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
std::vector<std::int64_t> first_ids(const Particles& particles, const ById& by_id,
                                    const std::vector<std::size_t>& before, base::Communicator& ranks) {
  constexpr std::int64_t most = std::numeric_limits<std::int64_t>::max();
  std::vector<std::int64_t> ends{most, -most};  // smallest id, and the largest
  for (const std::int64_t id : particles.id) ends[0] = std::min(ends[0], id), ends[1] = std::max(ends[1], id);
  ends[0] = -ends[0];
  ranks.max(ends);
  const std::size_t pieces = before.size();
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
      if (static_cast<std::size_t>(count[p]) > before[p + 1])
        high[p] = middle[p];
      else
        low[p] = std::min(high[p], middle[p] + 1);
    }
  }
  return low;
}

}  // namespace

std::vector<std::size_t> equal_pieces(std::size_t particles, std::size_t pieces) {
  std::vector<std::size_t> before(pieces);
  for (std::size_t p = 0; p < pieces; ++p)
    before[p] = p * (particles / pieces) + p * (particles % pieces) / pieces;  // the product might be too large
  return before;
}

std::vector<std::size_t> full_pieces(std::size_t particles, std::size_t most) {
  std::vector<std::size_t> before;
  for (std::size_t first = 0; first < particles; first += most) before.push_back(first);
  return before;
}

std::size_t particles_of_all(const Particles& particles, base::Communicator& ranks) {
  auto count = static_cast<std::int64_t>(particles.size());
  ranks.sum(std::span(&count, 1));
  return static_cast<std::size_t>(count);
}

void hand_out_by_id(const Particles& particles, const std::vector<std::size_t>& before, base::Communicator& ranks,
                    const Particles& none, const PackChosen& packed, const ReceivePiece& receive) {
  const std::size_t pieces = before.size();
  if (pieces == 0) return;
  const ById by_id(particles);
  const std::vector<std::int64_t> firsts = first_ids(particles, by_id, before, ranks);
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
        out[static_cast<std::size_t>(rank)] = packed(chosen);
      }
    });
    std::vector<base::Bytes> in = ranks.exchange(std::move(out));
    ranks.agree_on([&] {
      const std::size_t piece = base::piece_of_round(round, ranks.rank(), pieces, ranks.size());
      if (piece == pieces) return;
      Particles own = none;
      for (base::Bytes& bytes : in) unpack(bytes, own), bytes = {};
      sort_by_id(own);
      receive(piece, own);
    });
  }
}

}  // namespace gaussdrift
