#include "sim/density_pieces.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <utility>

#include "base/piece_writers.hpp"
#include "base/stopwatch.hpp"
#include "sim/transform_errors.hpp"

namespace gaussdrift {

namespace {

// A tile is summed in parts: its first layer on an axis is a part of its own where the piece before shows that layer,
// too. So layers that pieces share are summed once, before the pieces, and have the same bits in all of them.
LatticeBox part_of(const Tile& tile, unsigned borders, unsigned layers) {
  LatticeBox box = tile;
  for (unsigned k = 0; k < max_dimension; ++k) {
    if (layers >> k & 1u)
      box.points[k] = 1;
    else if (borders >> k & 1u)
      ++box.first[k], --box.points[k];
  }
  return box;
}

// The axes on which the tile begins with a layer that the piece before shows.
unsigned borders_of(const Tile& tile, const LatticeBox& piece) {
  unsigned axes = 0;
  for (unsigned k = 0; k < max_dimension; ++k)
    if (tile.first[k] > 0 && tile.first[k] == piece.first[k]) axes |= 1u << k;
  return axes;
}

template <class Use>
void each_subset(unsigned set, const Use& use) {  // not the empty one
  for (unsigned subset = set; subset > 0; subset = (subset - 1) & set) use(subset);
}

struct Layer {
  LatticeBox box;
  std::vector<double> values;  // of the density, then of each derivative
};

class PieceSums {
 public:
  PieceSums(const Tiles& tiles, const std::vector<int>& owner, const Lattice& lattice, const LatticePieces& pieces,
            std::size_t quantities, base::Communicator& ranks, const PieceReceiver& receiver, DensityReport& report)
      : tiles_(tiles.list()),
        owner_(owner),
        pieces_(pieces),
        quantities_(quantities),
        ranks_(ranks),
        receiver_(receiver),
        report_(report),
        every_(thinning(lattice)),
        thin_{thinned(lattice, every_), {}} {
    for (const Tile& tile : tiles_) piece_of_tile_.push_back(pieces.of(tile.first));
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile) tiles_of_piece_[piece_of_tile_[tile]].push_back(tile);
  }

  void sum(TileSums& sums) {
    layers_.clear();
    minimum_ = std::numeric_limits<double>::infinity(), maximum_ = -minimum_;
    thin_.rho.clear();
    if (ranks_.rank() == 0) thin_.rho.resize(thin_.lattice.size());
    receiver_.begin();
    sum_layers(sums);
    const std::size_t rounds = base::rounds_of_pieces(pieces_.count(), ranks_.size());
    for (std::size_t round = 0; round < rounds; ++round) sum_round(sums, round);
    layers_.clear();
  }

  /// What receivers took.
  double receiving_seconds() const { return receiving_; }

  PiecesSummary summary() {
    ranks_.min(std::span(&minimum_, 1));
    ranks_.max(std::span(&maximum_, 1));
    const bool first = ranks_.rank() == 0;
    const std::vector<base::Bytes> of_ranks = ranks_.gather(first ? base::Bytes() : base::to_bytes(thin_.rho));
    if (!first) thin_.rho.clear();
    for (std::size_t rank = 1; rank < of_ranks.size(); ++rank) {
      const auto values = base::from_bytes<double>(of_ranks[rank]);
      std::size_t next = 0;
      each_own_piece(static_cast<int>(rank), [&](std::size_t piece) {
        each_thin(pieces_.own(piece), [&](std::size_t i, std::size_t j, std::size_t l) {
          thin_.rho[thin_number(i, j, l)] = values[next++];
        });
      });
    }
    return {std::move(thin_), minimum_, maximum_};
  }

 private:
  std::size_t size() const { return static_cast<std::size_t>(ranks_.size()); }
  int writer(std::size_t piece) const { return base::writer_of_piece(piece, pieces_.count(), ranks_.size()); }
  bool is_own(std::size_t tile) const { return owner_[tile] == ranks_.rank(); }

  template <class Use>
  void each_own_piece(int rank, const Use& use) const {
    const std::size_t end = base::first_piece_of(rank + 1, pieces_.count(), ranks_.size());
    for (std::size_t piece = base::first_piece_of(rank, pieces_.count(), ranks_.size()); piece < end; ++piece)
      use(piece);
  }

  // use(box, ranks and pieces that show it) for each layer of a tile that pieces share.
  template <class Use>
  void each_layer(std::size_t tile, const Use& use) const {
    const std::size_t piece = piece_of_tile_[tile];
    const unsigned borders = borders_of(tiles_[tile], pieces_.own(piece));
    each_subset(borders, [&](unsigned layers) {
      std::map<int, std::vector<std::size_t>> shown_by{{writer(piece), {piece}}};
      each_subset(layers, [&](unsigned axes) {
        const std::size_t other = pieces_.before(piece, axes);
        shown_by[writer(other)].push_back(other);
      });
      use(part_of(tiles_[tile], borders, layers), shown_by);
    });
  }

  void sum_layers(TileSums& sums) {
    std::vector<std::vector<double>> out(size());
    ranks_.agree_on([&] {
      in_words_of_a_case([&] {
        for (std::size_t tile = 0; tile < tiles_.size(); ++tile) {
          if (!is_own(tile)) continue;
          each_layer(tile, [&](const LatticeBox& box, const auto& shown_by) {
            const std::vector<double> values = sums.sum(tile, box, false, report_);
            for (const auto& [rank, pieces] : shown_by) {
              auto& to = out[static_cast<std::size_t>(rank)];
              to.insert(to.end(), values.begin(), values.end());
            }
          });
        }
      });
    });
    const std::vector<std::vector<double>> in = exchanged(std::move(out));
    std::vector<std::size_t> next(size(), 0);
    for (std::size_t tile = 0; tile < tiles_.size(); ++tile)
      each_layer(tile, [&](const LatticeBox& box, const auto& shown_by) {
        const auto here = shown_by.find(ranks_.rank());
        if (here == shown_by.end()) return;
        const auto from = static_cast<std::size_t>(owner_[tile]);
        const auto begin = in[from].begin() + static_cast<std::ptrdiff_t>(next[from]);
        const std::size_t count = quantities_ * box.size();
        next[from] += count;
        const auto layer = std::make_shared<const Layer>(
            Layer{box, std::vector<double>(begin, begin + static_cast<std::ptrdiff_t>(count))});
        for (const std::size_t piece : here->second) layers_[piece].push_back(layer);
      });
  }

  std::vector<std::vector<double>> exchanged(std::vector<std::vector<double>> out) {
    std::vector<base::Bytes> bytes;
    for (auto& values : out) bytes.push_back(base::to_bytes(values)), values = {};
    std::vector<std::vector<double>> in;
    for (base::Bytes& one : ranks_.exchange(std::move(bytes))) in.push_back(base::from_bytes<double>(one)), one = {};
    return in;
  }

  // One piece for each rank that has so many.
  void sum_round(TileSums& sums, std::size_t round) {
    std::vector<std::size_t> now;  // by rank; none: the number of pieces
    for (int rank = 0; rank < ranks_.size(); ++rank)
      now.push_back(base::piece_of_round(round, rank, pieces_.count(), ranks_.size()));
    const auto self = static_cast<std::size_t>(ranks_.rank());
    const bool shows = now[self] < pieces_.count();
    const LatticeBox shown = shows ? pieces_.shown(now[self]) : LatticeBox{{}, {0, 0, 0}};
    std::vector<double> values;
    std::vector<std::vector<double>> out(size());
    ranks_.agree_on([&] {
      values.resize(quantities_ * shown.size());
      in_words_of_a_case([&] {
        for (std::size_t rank = 0; rank < size(); ++rank) {
          if (now[rank] == pieces_.count()) continue;
          for (const std::size_t tile : tiles_of_piece_[now[rank]]) {
            if (!is_own(tile)) continue;
            const LatticeBox box = main_part(tile);
            const std::vector<double> some = sums.sum(tile, box, true, report_);
            if (rank == self)
              put(some, box, shown, values);
            else
              out[rank].insert(out[rank].end(), some.begin(), some.end());
          }
        }
      });
    });
    const std::vector<std::vector<double>> in = exchanged(std::move(out));
    ranks_.agree_on([&] {
      if (!shows) return;
      std::vector<std::size_t> next(size(), 0);
      for (const std::size_t tile : tiles_of_piece_[now[self]]) {
        if (is_own(tile)) continue;
        const auto from = static_cast<std::size_t>(owner_[tile]);
        const LatticeBox box = main_part(tile);
        const std::size_t count = quantities_ * box.size();
        put(std::span(in[from]).subspan(next[from], count), box, shown, values);
        next[from] += count;
      }
      for (const auto& layer : layers_[now[self]]) put(layer->values, layer->box, shown, values);
      layers_.erase(now[self]);
      look_at(now[self], shown, values);
      const base::Stopwatch receiving;
      receiver_.piece(now[self], values);
      receiving_ += receiving.seconds();
    });
  }

  LatticeBox main_part(std::size_t tile) const {
    return part_of(tiles_[tile], borders_of(tiles_[tile], pieces_.own(piece_of_tile_[tile])), 0);
  }

  // Values of a box into those of a larger one.
  void put(std::span<const double> some, const LatticeBox& box, const LatticeBox& all,
           std::vector<double>& values) const {
    for (std::size_t q = 0; q < quantities_; ++q)
      for (std::size_t l = 0; l < box.points[2]; ++l)
        for (std::size_t j = 0; j < box.points[1]; ++j)
          std::copy_n(
              some.begin() + static_cast<std::ptrdiff_t>(q * box.size() + (l * box.points[1] + j) * box.points[0]),
              box.points[0],
              values.begin() + static_cast<std::ptrdiff_t>(
                                   q * all.size() + all.number(box.first[0], box.first[1] + j, box.first[2] + l)));
  }

  template <class Use>
  void each_thin(const LatticeBox& own, const Use& use) const {
    const auto first = [&](std::size_t k) { return (own.first[k] + every_ - 1) / every_ * every_; };
    for (std::size_t l = first(2); l < own.end(2); l += every_)
      for (std::size_t j = first(1); j < own.end(1); j += every_)
        for (std::size_t i = first(0); i < own.end(0); i += every_) use(i, j, l);
  }

  std::size_t thin_number(std::size_t i, std::size_t j, std::size_t l) const {
    const auto& points = thin_.lattice.points;
    return i / every_ + points[0] * (j / every_ + points[1] * (l / every_));
  }

  void look_at(std::size_t piece, const LatticeBox& shown, const std::vector<double>& values) {
    const auto [low, high] =
        std::minmax_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(shown.size()));
    minimum_ = std::min(minimum_, *low), maximum_ = std::max(maximum_, *high);
    each_thin(pieces_.own(piece), [&](std::size_t i, std::size_t j, std::size_t l) {
      const double value = values[shown.number(i, j, l)];
      if (ranks_.rank() == 0)
        thin_.rho[thin_number(i, j, l)] = value;
      else
        thin_.rho.push_back(value);
    });
  }

  const std::vector<Tile>& tiles_;
  const std::vector<int>& owner_;
  const LatticePieces& pieces_;
  const std::size_t quantities_;
  base::Communicator& ranks_;
  const PieceReceiver& receiver_;
  DensityReport& report_;
  const std::size_t every_;
  DensityGrid thin_;  // on rank 0; elsewhere the values of this rank's pieces, one after another
  std::vector<std::size_t> piece_of_tile_;
  std::map<std::size_t, std::vector<std::size_t>> tiles_of_piece_;
  std::map<std::size_t, std::vector<std::shared_ptr<const Layer>>> layers_;  // by piece of this rank
  double minimum_ = 0, maximum_ = 0, receiving_ = 0;
};

}  // namespace

PiecesSummary sum_pieces(const TileSources& sources, const Tiles& tiles, const std::vector<int>& owner,
                         const Cutoff& cutoff, const Lattice& lattice, const LatticePieces& pieces,
                         const DensityOptions& options, base::Communicator& ranks, const PieceReceiver& receiver,
                         DensityReport& report) {
  std::vector<char> owned;
  for (const int rank : owner) owned.push_back(rank == ranks.rank());
  PieceSums all(tiles, owner, lattice, pieces, options.quantities(), ranks, receiver, report);
  sum_by_tiles(
      sources, tiles, owned, cutoff, lattice, options, ranks, [&](TileSums& sums) { all.sum(sums); }, report);
  report.evaluate_seconds -= all.receiving_seconds();
  return all.summary();
}

}  // namespace gaussdrift
