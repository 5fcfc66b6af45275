#include "sim/placement.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <numeric>
#include <span>
#include <utility>

#include "base/exact_sum.hpp"
#include "base/parallel.hpp"

namespace gaussdrift {

namespace {

constexpr std::size_t most_addends = 16;  // numbers of a frame, or named densities

// Whole numbers without an order: the particles with the smallest ones are a random choice that is always the same.
std::uint64_t shuffled(std::int64_t id) {
  auto x = static_cast<std::uint64_t>(id) + 0x9e3779b97f4a7c15;  // the finaliser of splitmix64
  x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9;
  x = (x ^ x >> 27) * 0x94d049bb133111eb;
  return x ^ x >> 31;
}

std::vector<std::size_t> first_in_shuffled_order(const Particles& particles, std::size_t most) {
  std::vector<std::size_t> order(particles.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const std::size_t count = std::min(most, order.size());
  const auto middle = order.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(order.begin(), count < order.size() ? middle : order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return shuffled(particles.id[a]) < shuffled(particles.id[b]); });
  order.resize(count);
  std::sort(order.begin(), order.end());
  return order;
}

}  // namespace

void Placement::renew(Particles& particles, Tiles tiles, const std::function<double(const Tile& tile)>& work) {
  tiles_.emplace(std::move(tiles));
  std::vector<double> of_tiles;
  for (const Tile& tile : tiles_->list()) of_tiles.push_back(work(tile));
  owner_ = one_tile() ? std::vector<int>{0} : share_tiles(of_tiles, ranks_.size());
  place_particles(particles, *tiles_, owner_, ranks_);
}

std::size_t Placement::particle_count() const {
  std::int64_t count = 0;
  if (tiles_)
    for (const Tile& tile : tiles_->list()) count += tile.particles;
  return static_cast<std::size_t>(count);
}

std::vector<char> Placement::owned() const {
  std::vector<char> own;
  for (const int rank : owner_) own.push_back(rank == ranks_.rank());
  return own;
}

std::vector<double> Placement::sums(const Particles& particles, std::size_t count, int threads,
                                    const std::function<void(std::size_t j, double* addends)>& fill) const {
  std::vector<double> totals(count, 0.0);
  std::array<double, most_addends> addends{};
  if (one_tile()) {
    for (std::size_t j = 0; j < particles.size(); ++j) {
      fill(j, addends.data());
      for (std::size_t i = 0; i < count; ++i) totals[i] += addends[i];
    }
    base::Bytes bytes = base::to_bytes(totals);
    ranks_.broadcast(bytes);
    return base::from_bytes<double>(bytes);
  }
  std::vector<base::ExactSum> exact(count);
  constexpr std::size_t length = 65536;
  const std::size_t pieces = (particles.size() + length - 1) / length;
  std::mutex mutex;
  base::parallel_for({pieces, 20e-9 * static_cast<double>(particles.size())}, threads, [&](std::size_t piece) {
    std::vector<base::ExactSum> own(count);
    std::array<double, most_addends> values{};
    for (std::size_t j = piece * length; j < std::min(particles.size(), (piece + 1) * length); ++j) {
      fill(j, values.data());
      for (std::size_t i = 0; i < count; ++i) own[i].add(values[i]);
    }
    const std::lock_guard lock(mutex);
    for (std::size_t i = 0; i < count; ++i) exact[i].add(own[i]);
  });
  sum_over_ranks(ranks_, exact);
  for (std::size_t i = 0; i < count; ++i) totals[i] = exact[i].value();
  return totals;
}

double Placement::max(double number) const {
  ranks_.max(std::span(&number, 1));
  return number;
}

Particles Placement::sample(const Particles& particles, std::size_t most) const {
  std::vector<std::size_t> chosen;
  if (one_tile()) {
    const std::size_t count = std::min(most, particles.size());
    for (std::size_t i = 0; i < count; ++i) chosen.push_back(i * particles.size() / count);
  } else {
    chosen = first_in_shuffled_order(particles, most);
  }
  Particles some;
  some.dimension = particles.dimension;
  for (const base::Bytes& bytes : ranks_.gather(pack_bare(particles, chosen))) unpack(bytes, some);
  if (is_first() && some.size() > most) {
    const std::vector<std::size_t> first = first_in_shuffled_order(some, most);
    const base::Bytes bytes = pack_bare(some, first);
    some = {};
    some.dimension = particles.dimension;
    unpack(bytes, some);
  }
  std::vector<std::size_t> all(some.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  sort_by_id(some);
  base::Bytes bytes = pack_bare(some, all);
  ranks_.broadcast(bytes);
  if (is_first()) return some;
  Particles told;
  told.dimension = particles.dimension;
  unpack(bytes, told);
  return told;
}

}  // namespace gaussdrift
