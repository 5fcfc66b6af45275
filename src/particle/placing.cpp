#include "particle/placing.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "base/return_memory.hpp"
#include "particle/columns.hpp"
#include "particle/subset.hpp"

namespace gaussdrift {

namespace {

std::size_t columns_of(const Particles& particles) {
  std::size_t columns = 0;
  for_each_column(particles, [&](std::string_view, std::size_t, const auto&) { ++columns; });
  return columns;
}

template <class T>
void permute(std::vector<T>& column, const std::vector<std::pair<std::int64_t, std::size_t>>& order) {
  std::vector<T> sorted(column.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = column[order[i].second];
  column = std::move(sorted);
}

// The same columns, without particles.
Particles empty_like(const Particles& particles) {
  Particles none;
  none.dimension = particles.dimension;
  none.path.resize(particles.path.size());
  none.kept.resize(particles.kept.size());
  none.tracers.resize(particles.tracers.size());
  none.spread = particles.spread;
  return none;
}

// Every particle for one rank, as pack() has them.
template <class RankOf>
std::vector<base::Bytes> packed_by_rank(const Particles& particles, std::size_t ranks, const RankOf& rank_of) {
  std::vector<std::uint32_t> rank(particles.size());
  std::vector<std::size_t> count(ranks, 0);
  for (std::size_t j = 0; j < rank.size(); ++j) {
    rank[j] = static_cast<std::uint32_t>(rank_of(j));
    ++count[rank[j]];
  }
  const std::size_t columns = columns_of(particles);
  std::vector<base::Bytes> out(ranks);
  std::vector<std::byte*> to(ranks, nullptr);
  const auto has_volume = static_cast<std::int64_t>(!particles.volume.empty());
  for (std::size_t r = 0; r < ranks; ++r) {
    if (count[r] == 0) continue;
    out[r].resize(8 * (1 + columns * count[r]));
    std::memcpy(out[r].data(), &has_volume, 8);
    to[r] = out[r].data() + 8;
  }
  for_each_column(particles, [&](std::string_view, std::size_t, const auto& column) {
    for (std::size_t j = 0; j < rank.size(); ++j) {
      std::memcpy(to[rank[j]], &column[j], 8);
      to[rank[j]] += 8;
    }
  });
  return out;
}

// What arrives, in columns that are as long as they have to be. `like`: with the same columns.
Particles arrived(std::vector<base::Bytes> in, const Particles& like) {
  Particles all = empty_like(like);
  std::size_t bytes = 0;
  for (const base::Bytes& of_rank : in) bytes += of_rank.size();
  const std::size_t most = bytes / 8 / columns_of(all);
  for_each_column(all, [&](std::string_view, std::size_t, auto& column) { column.reserve(most); });
  for (base::Bytes& of_rank : in) {
    unpack(of_rank, all);
    of_rank = {};
  }
  sort_by_id(all);
  return all;
}

}  // namespace

std::vector<int> share_tiles(const std::vector<double>& work, int ranks) {
  const double all = std::accumulate(work.begin(), work.end(), 0.0);
  std::vector<int> owner(work.size(), 0);
  double before = 0;
  for (std::size_t t = 0; t < work.size(); ++t) {
    const double middle = before + work[t] / 2;
    if (all > 0) owner[t] = std::min(ranks - 1, static_cast<int>(middle / all * ranks));
    before += work[t];
  }
  return owner;
}

base::Bytes pack(const Particles& particles, const std::vector<std::size_t>& chosen) {
  if (chosen.empty()) return {};
  const std::size_t length = 8 * chosen.size();
  base::Bytes bytes(8 + columns_of(particles) * length);
  const auto has_volume = static_cast<std::int64_t>(!particles.volume.empty());
  std::byte* to = bytes.data();
  std::memcpy(to, &has_volume, 8), to += 8;
  for_each_column(particles, [&](std::string_view, std::size_t, const auto& column) {
    for (std::size_t i = 0; i < chosen.size(); ++i) std::memcpy(to + 8 * i, &column[chosen[i]], 8);
    to += length;
  });
  return bytes;
}

base::Bytes pack_bare(const Particles& particles, const std::vector<std::size_t>& chosen) {
  std::vector<std::size_t> all(chosen.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return pack(subset(particles, chosen), all);
}

void unpack(std::span<const std::byte> bytes, Particles& particles) {
  if (bytes.empty()) return;
  std::int64_t has_volume = 0;
  std::memcpy(&has_volume, bytes.data(), 8);
  const bool first_volumes =
      has_volume != 0 && particles.volume.empty();  // for_each_column() knows nothing of them yet
  const std::size_t columns = columns_of(particles) + (first_volumes ? 1 : 0);
  const std::size_t count = (bytes.size() - 8) / 8 / columns, before = particles.size();
  if (bytes.size() != 8 * (1 + columns * count)) throw std::logic_error("unpack(): these are not such particles");
  const std::byte* from = bytes.data() + 8;
  const auto take = [&](auto& column) {
    column.resize(before + count);
    std::memcpy(column.data() + before, from, 8 * count);
    from += 8 * count;
  };
  for_each_column(particles, [&](std::string_view, std::size_t, auto& column) { take(column); });
  if (first_volumes) take(particles.volume);
}

// Few ascending runs, one of each rank, are merged.
void sort_by_id(Particles& particles) {
  std::vector<std::size_t> start{0};  // of each run, and the end
  for (std::size_t j = 1; j < particles.id.size(); ++j)
    if (particles.id[j] < particles.id[j - 1]) start.push_back(j);
  if (start.size() == 1) return;
  start.push_back(particles.id.size());
  using Place = std::pair<std::int64_t, std::size_t>;  // an id, and where it stands
  std::vector<Place> places(particles.id.size());
  for (std::size_t j = 0; j < places.size(); ++j) places[j] = {particles.id[j], j};
  const auto at = [&](std::size_t run) { return places.begin() + static_cast<std::ptrdiff_t>(start[run]); };
  const std::size_t runs = start.size() - 1;
  for (std::size_t step = 1; step < runs; step *= 2)
    for (std::size_t run = 0; run + step < runs; run += 2 * step)
      std::inplace_merge(at(run), at(run + step), at(std::min(run + 2 * step, runs)));
  for_each_column(particles, [&](std::string_view, std::size_t, auto& column) { permute(column, places); });
}

void place_particles(Particles& particles, const Tiles& tiles, const std::vector<int>& owner,
                     base::Communicator& ranks) {
  if (ranks.size() == 1) return;
  const PointsView x = particles.view();
  std::vector<base::Bytes> out = packed_by_rank(particles, static_cast<std::size_t>(ranks.size()), [&](std::size_t j) {
    return static_cast<std::size_t>(owner[tiles.of(x.at(j))]);
  });
  particles = empty_like(particles);  // what is on its way need not stand here as well
  base::return_memory();
  particles = arrived(ranks.exchange(std::move(out)), particles);
  base::return_memory();
}

Particles felt_from_elsewhere(const Particles& particles, const Tiles& tiles, const std::vector<int>& owner,
                              base::Communicator& ranks) {
  Particles bare;  // what a sum of blobs needs
  bare.dimension = particles.dimension;
  if (ranks.size() == 1) return bare;
  std::vector<std::vector<std::size_t>> chosen(static_cast<std::size_t>(ranks.size()));
  const PointsView x = particles.view();
  for (std::size_t j = 0; j < particles.size(); ++j)
    tiles.within_reach(x.at(j), [&](std::size_t tile) {
      const int rank = owner[tile];
      if (rank == ranks.rank()) return;
      auto& list = chosen[static_cast<std::size_t>(rank)];
      if (list.empty() || list.back() != j) list.push_back(j);
    });
  std::vector<base::Bytes> out;
  for (const auto& list : chosen) out.push_back(pack_bare(particles, list));
  for (const base::Bytes& bytes : ranks.exchange(std::move(out))) unpack(bytes, bare);
  sort_by_id(bare);
  return bare;
}

Particles gather_particles(const Particles& particles, base::Communicator& ranks) {
  std::vector<base::Bytes> out =
      packed_by_rank(particles, static_cast<std::size_t>(ranks.size()), [](std::size_t) { return std::size_t{0}; });
  return arrived(ranks.exchange(std::move(out)), particles);
}

}  // namespace gaussdrift
