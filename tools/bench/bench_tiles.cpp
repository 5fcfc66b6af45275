// A density by tiles against one sum for all: processor seconds on one thread, alternating, and what the tiles of N
// ranks take together and at most. Each rank is a thread, and they work in turns, so that none has to share caches and
// memory with another. docs/distributed.md has the table.
//
//   bench_tiles [rounds]          all rows
//   bench_tiles [rounds] ROW      one of: cone2 cone3 uniform3
//   bench_tiles memory ROW plan|tiles   one density, and the peak memory of the process beyond its particles
#include <fmt/format.h>
#include <sys/resource.h>
#include <time.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <mutex>
#include <numbers>
#include <string>
#include <vector>

#include "../../tests/ranks_of_threads.hpp"
#include "particle/placing.hpp"
#include "sim/tiled_density.hpp"

using namespace gaussdrift;

namespace {

double processor_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

double peak_mib() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

struct Row {
  std::string name;
  int dimension;
  double particles;
  int per_axis;
  double tolerance;
  bool cone;  // in 2 % of the box; else everywhere
};

const std::vector<Row> rows = {
    {"cone2", 2, 1e7, 2000, 1e-8, true}, {"cone3", 3, 8e6, 256, 1e-6, true}, {"uniform3", 3, 8e6, 256, 1e-6, false}};

struct Scene {
  Particles particles;
  Lattice lattice;
  Cutoff cutoff;
  DensityOptions options;
};

// Points of a lattice, weights of Wendland's cone or all the same, blobs two spacings wide.
Scene make(const Row& row) {
  Scene scene;
  const int d = row.dimension;
  const double radius = d == 2 ? 0.16 : 0.33;
  const double volume = !row.cone ? std::pow(2.0, d)
                        : d == 2  ? std::numbers::pi * radius * radius
                                  : 4 * std::numbers::pi / 3 * std::pow(radius, 3);
  const double h = std::pow(volume / row.particles, 1.0 / d);
  const auto per_axis = static_cast<std::int64_t>(2 / h) + 1;
  scene.particles.dimension = d;
  for (std::int64_t z = 0; z < (d == 3 ? per_axis : 1); ++z)
    for (std::int64_t y = 0; y < per_axis; ++y)
      for (std::int64_t x = 0; x < per_axis; ++x) {
        const double place[3] = {-1 + h * static_cast<double>(x), -1 + h * static_cast<double>(y),
                                 d == 3 ? -1 + h * static_cast<double>(z) : 0};
        double weight = 1;
        if (row.cone) {
          const double r = std::hypot(place[0] - 0.5, place[1], place[2]) / radius;
          if (r >= 1) continue;
          weight = std::pow(1 - r, 4) * (4 * r + 1);
        }
        for (int k = 0; k < d; ++k) scene.particles.position[k].push_back(place[k]);
        scene.particles.alpha.push_back(weight * std::pow(h, d));
        scene.particles.id.push_back(x + per_axis * (y + per_axis * z));
      }
  scene.lattice = make_lattice(d, {-1, -1, -1}, {1, 1, 1}, row.per_axis);
  scene.cutoff = make_cutoff("gauss2", d, 2 * h);
  scene.options.tolerance = row.tolerance;
  scene.options.threads = 1;
  scene.options.measure = false;
  return scene;
}

double seconds_of(const Scene& scene, bool tiled) {
  DensityOptions options = scene.options;
  if (!tiled) options.tiles = TileLimits{.particles = std::int64_t{1} << 60, .points = std::int64_t{1} << 60};
  const double begun = processor_seconds();
  evaluate_density(scene.particles, scene.cutoff, scene.lattice, options);
  return processor_seconds() - begun;
}

struct OfRanks {
  double sum = 0, largest = 0;
  std::size_t felt = 0;  // particles sent to other ranks, together
};

OfRanks on(int size, const Scene& scene) {
  OfRanks all;
  std::mutex mutex;
  on_ranks(
      size,
      [&](base::Communicator& ranks) {
        std::vector<std::size_t> some;
        for (std::size_t j = 0; j < scene.particles.size(); ++j)
          if (j / 1024 % static_cast<std::size_t>(size) == static_cast<std::size_t>(ranks.rank())) some.push_back(j);
        Particles own;
        own.dimension = scene.particles.dimension;
        unpack(pack(scene.particles, some), own);
        const auto tiles_now = [&] {
          return tiles_of(own, scene.cutoff, scene.lattice, scene.options,
                          [&](std::vector<std::int64_t>& counts) { ranks.sum(counts); });
        };
        const Tiles tiles = tiles_now();
        std::vector<double> work;
        for (const Tile& tile : tiles.list())
          work.push_back(tile.sources + (own.dimension == 2 ? 0.1 : 0.035) * static_cast<double>(tile.size()));
        const std::vector<int> owner = share_tiles(work, size);
        place_particles(own, tiles, owner, ranks);
        std::vector<char> owned;
        for (const int rank : owner) owned.push_back(rank == ranks.rank());
        ranks.barrier();
        const double begun = processor_seconds();
        const Particles felt = felt_from_elsewhere(own, tiles, owner, ranks);
        DensityReport report;
        evaluate_tiles({own, felt}, tiles, owned, scene.cutoff, scene.lattice, scene.options, ranks, report);
        const double seconds = processor_seconds() - begun;
        const std::lock_guard lock(mutex);
        all.sum += seconds, all.largest = std::max(all.largest, seconds), all.felt += felt.size();
      },
      1, InTurns::yes);
  return all;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

void measure(const Row& row, int rounds) {
  const Scene scene = make(row);
  const Tiles tiles = tiles_of(scene.particles, scene.cutoff, scene.lattice, scene.options);
  std::vector<double> one, tiled, ratio, sum, largest;
  OfRanks four;
  for (int i = 0; i < rounds; ++i) {
    one.push_back(seconds_of(scene, false));
    tiled.push_back(seconds_of(scene, true));
    ratio.push_back(tiled.back() / one.back());
    four = on(4, scene);
    sum.push_back(four.sum / tiled.back());
    largest.push_back(four.largest / (four.sum / 4));
  }
  fmt::print(
      "{:9} {:.3g} particles, {}^{} points, {:g}: {} tiles; one sum {:.3g} s, tiles {:.3g} s, ratio {:.3f}; 4 ranks: "
      "sum "
      "{:.3f} of one rank, largest {:.3f} of the mean, {:.3g} MB sent\n",
      row.name, static_cast<double>(scene.particles.size()), row.per_axis, row.dimension, row.tolerance,
      tiles.list().size(), median(one), median(tiled), median(ratio), median(sum), median(largest),
      static_cast<double>(four.felt) * 8e-6 * (row.dimension + 2));
}

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (!given.empty() && given[0] == "memory") {
    for (const Row& row : rows) {
      if (row.name != given.at(1)) continue;
      const Scene scene = make(row);
      const double before = peak_mib();
      const double seconds = seconds_of(scene, given.at(2) == "tiles");
      fmt::print("{} {}: {:.3g} s, {:.0f} MiB, of them {:.0f} before\n", row.name, given[2], seconds, peak_mib(),
                 before);
    }
    return 0;
  }
  const int rounds = given.empty() ? 3 : std::atoi(given[0].c_str());
  for (const Row& row : rows)
    if (given.size() < 2 || given[1] == row.name) measure(row, rounds);
}
