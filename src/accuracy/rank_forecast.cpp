#include "accuracy/rank_forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <numeric>
#include <utility>
#include <vector>

#include "accuracy/footprint.hpp"
#include "accuracy/trial.hpp"
#include "base/counted.hpp"
#include "base/size_text.hpp"
#include "effect/catalogue.hpp"
#include "gaussdrift/accuracy.hpp"
#include "particle/cutoff.hpp"
#include "particle/placing.hpp"
#include "particle/tiles.hpp"
#include "sim/fields_on_grid.hpp"
#include "sim/grid_pieces.hpp"
#include "sim/scene.hpp"
#include "sim/sharing.hpp"
#include "sim/tiled_density.hpp"
#include "write/checkpoint.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr std::size_t trial_particles = 400'000;

/// What a rank has: as many particles and grid points as its tiles, and particles of others that are felt there.
struct Share {
  double work = 0, particles = 0, felt = 0, points = 0;
  std::size_t tiles = 0;
};

/// Some particles stand for `each` of the case.
std::vector<Share> shares(const Trial& trial, const Tiles& tiles, const std::vector<int>& owner,
                          const std::vector<double>& work, int ranks) {
  const double each = trial.each();
  std::vector<Share> all(static_cast<std::size_t>(ranks));
  for (std::size_t t = 0; t < owner.size(); ++t) {
    Share& share = all[static_cast<std::size_t>(owner[t])];
    const Tile& tile = tiles.list()[t];
    ++share.tiles;
    share.work += work[t];
    share.particles += static_cast<double>(tile.particles) * each;
    share.points += static_cast<double>(tile.size());
  }
  const Particles& particles = trial.particles;
  std::vector<int> told;  // ranks that have been given this particle
  for (std::size_t j = 0; j < particles.size(); ++j) {
    Vector x{};
    for (int k = 0; k < particles.dimension; ++k) x[k] = particles.position[k][j];
    const int home = owner[tiles.of(x)];
    told.assign(1, home);
    tiles.within_reach(x, [&](std::size_t tile) {
      const int rank = owner[tile];
      if (std::find(told.begin(), told.end(), rank) != told.end()) return;
      told.push_back(rank);
      all[static_cast<std::size_t>(rank)].felt += each;
    });
  }
  return all;
}

/// Nobody explains the errors.
Case unexplained(Case spec) {
  spec.output.report = false;
  spec.accuracy.budget = AccuracySpec::Budget::none;
  return spec;
}

/// The case as the ranks beside the first see it: they draw and explain nothing, and write their pieces alone.
Case without_outputs(Case spec, bool particles_in_pieces) {
  spec.output.images.clear();
  spec.output.animation.reset();
  const bool grid_in_pieces = pieces_of_grid(spec).count() > 1;
  std::erase_if(spec.output.files, [&](const OutputFile& file) {
    const write::FileKind& kind = write::find_output_file(file.name);
    return !(kind.piece && grid_in_pieces) && !(kind.particle_piece && particles_in_pieces);
  });
  return unexplained(std::move(spec));
}

/// While a checkpoint is written: its own particles, a copy of those that are on their way, and a piece as it arrives
/// and as it is written.
RunMemory memory_at_checkpoint(const Case& spec, double own, double all) {
  if (spec.output.checkpoint == 0.0) return {};
  const double piece = std::min(all, static_cast<double>(write::usual_checkpoint_piece));
  return {.particles = bytes_of_particle(spec) * 2 * (own + piece)};
}

/// Rank 0 gets all particles where a file without pieces or what explains the errors needs them.
bool first_needs_all_particles(const Case& spec, bool in_pieces) {
  return std::any_of(spec.output.files.begin(), spec.output.files.end(),
                     [&](const OutputFile& file) {
                       const write::FileKind& kind = write::find_output_file(file.name);
                       return !(in_pieces && kind.particle_piece) && kind.bytes({.particles = 1e6}) > kind.bytes({});
                     }) ||
         spec.output.report || spec.accuracy.budget != AccuracySpec::Budget::none;
}

TileLimits limits_of(const Case& spec, double each) {
  TileLimits limits = usual_tiles(spec.domain.dimension);
  if (spec.evaluate.tile_particles > 0) limits.particles = static_cast<std::int64_t>(spec.evaluate.tile_particles);
  limits.pieces = pieces_of_grid(spec).halvings();
  limits.particles = std::max<std::int64_t>(1, std::llround(static_cast<double>(limits.particles) / each));
  return limits;
}

}  // namespace

std::size_t most_useful_ranks(const std::vector<double>& work) {
  const double all = std::accumulate(work.begin(), work.end(), 0.0);
  if (!(all > 0)) return 1;
  // Each part of the work as long as the largest distance between middles of tiles has one of them.
  double before = 0, last = 0, widest = 0;
  for (const double of_tile : work) {
    const double middle = before + of_tile / 2;
    widest = std::max(widest, middle - last);
    last = middle, before += of_tile;
  }
  widest = std::max(widest, all - last);
  const auto busy = [&](std::size_t ranks) {
    std::vector<int> owner = share_tiles(work, static_cast<int>(ranks));
    owner.erase(std::unique(owner.begin(), owner.end()), owner.end());
    return owner.size() == ranks;
  };
  std::size_t ranks = std::max<std::size_t>(1, static_cast<std::size_t>(all / widest));
  while (ranks > 1 && !busy(ranks)) --ranks;  // rounding
  while (ranks < work.size() && busy(ranks + 1)) ++ranks;
  return ranks;
}

RankForecast forecast_ranks(const Case& spec, double particles_at_most, double program, int ranks) {
  const Trial trial = make_trial(spec, trial_particles, 1);
  RankForecast result;
  result.ranks = ranks;
  result.whole = trial.whole;
  result.refused = why_not_shared(*trial.scene.velocity);
  // Blobs as wide as those of the case, whose sample has wider ones.
  Scene scene;
  scene.seeding = trial.lattice;
  set_blob(spec.particles, scene);
  const Cutoff& blob = scene.cutoff;
  const Lattice grid = evaluation_lattice(spec);
  const double each = trial.each();
  DensityOptions options;
  options.derivatives = derivatives_of(spec.output, spec.domain.dimension);
  const Tiles tiles(grid, reach_of_blob(blob, options), trial.particles.view(), limits_of(spec, each));
  const auto work_of = work_of_tiles(spec, *trial.scene.velocity, 0);
  std::vector<double> work;
  for (Tile tile : tiles.list()) {
    tile.particles = std::llround(static_cast<double>(tile.particles) * each);
    tile.sources *= each;
    work.push_back(work_of(tile));
  }
  const bool one = work.size() == 1, interact = particles_interact(spec.effects) && ranks > 1;
  const std::vector<int> owner = one ? std::vector<int>{0} : share_tiles(work, ranks);
  const std::vector<Share> all = shares(trial, tiles, owner, work, ranks);

  result.tiles = work.size();
  result.most_ranks = most_useful_ranks(work);
  double most = 0, sum = 0;
  for (const Share& share : all) most = std::max(most, share.work), sum += share.work;
  result.balance = sum > 0 ? most * ranks / sum : 1;
  const double bytes = 8.0 * (spec.domain.dimension + 2);  // of a particle: its place, weight and id
  const bool in_pieces = particles_at_most > spec.output.piece_particles;
  const Case bare = without_outputs(spec, in_pieces);
  // Particles that come in pieces are brought together for nobody.
  const Case of_first = in_pieces && ranks > 1 ? unexplained(spec) : spec;
  double particles = 0;
  for (const Share& share : all) particles += share.particles;
  const double gathered = static_cast<double>(shown_grid(spec).size()) / static_cast<double>(grid.size());
  const double grows = trial.carried > 0 ? particles_at_most / trial.carried : 1;  // by effects
  Extent extent{.lattice_points = static_cast<double>(trial.lattice.size()) / ranks};
  result.memory.resize(all.size());
  for (std::size_t r = 0; r < all.size(); ++r) {
    result.idle += all[r].tiles == 0;
    result.halo_bytes = std::max(result.halo_bytes, bytes * all[r].felt);
    // All but one of as many particles as there are ranks are summed for elsewhere than they are.
    const double summed = bytes * particles / ranks, home = 8.0 * spec.domain.dimension * all[r].particles;
    if (interact) result.pair_bytes = std::max(result.pair_bytes, (summed + home) * (ranks - 1) / ranks);
    if (r == 0) continue;
    result.gathered_bytes += 8 * all[r].points * gathered;
    extent.particles = grows * (all[r].particles + all[r].felt), extent.grid_points = all[r].points;
    result.memory[r] = memory_of_run(bare, extent);
    result.other_memory = std::max(result.other_memory, result.memory[r].all() + program);
  }
  extent.particles =
      first_needs_all_particles(of_first, in_pieces) ? particles_at_most : grows * (all[0].particles + all[0].felt);
  extent.grid_points = static_cast<double>(grid.size());
  extent.compared_everywhere = spec.reference.kind != ReferenceSpec::Kind::none;
  result.memory[0] = memory_of_run(of_first, extent);
  for (std::size_t r = 0; r < all.size() && ranks > 1; ++r) {
    const RunMemory keeping = memory_at_checkpoint(spec, grows * all[r].particles, particles_at_most);
    if (result.memory[r].all() < keeping.all()) result.memory[r] = keeping;
    if (r > 0) result.other_memory = std::max(result.other_memory, result.memory[r].all() + program);
  }
  result.first_memory = result.memory[0].all() + program;
  return result;
}

std::string to_text(const RankForecast& r) {
  const std::string ranks = base::counted(static_cast<std::size_t>(r.ranks), "rank");
  if (!r.refused.empty() && r.ranks > 1)
    return fmt::format("ranks      {}, so that {} cannot share this case; start it on one rank\n", r.refused, ranks);
  std::string text = fmt::format("ranks      {}: {}", ranks, base::counted(r.tiles, "tile"));
  text += r.idle > 0 ? fmt::format(", {} idle", base::counted(r.idle, "rank"))
                     : fmt::format(", the busiest has {:.2f} times the mean work", r.balance);
  text += fmt::format("; with more than {} some are idle\n", r.most_ranks);
  text += fmt::format("           of a density a rank receives up to {} of particles, and rank 0 gathers {}\n",
                      base::size_text(r.halo_bytes), base::size_text(r.gathered_bytes));
  if (r.pair_bytes > 0)
    text += fmt::format(
        "           all ranks sum the velocities that particles give each other, and receive up to {} each time\n",
        base::size_text(r.pair_bytes));
  text += fmt::format("           memory of rank 0 {}", base::size_text(r.first_memory));
  if (r.ranks > 1) text += fmt::format(", of the largest other {}", base::size_text(r.other_memory));
  return text + fmt::format("; all of this is computed from {} at the start, not measured\n",
                            r.whole ? "the particles" : "a sample of the particles");
}

std::string to_json(const RankForecast& r) {
  const nlohmann::ordered_json document{{"ranks", r.ranks},
                                        {"refused", r.refused},
                                        {"tiles", r.tiles},
                                        {"most_useful_ranks", r.most_ranks},
                                        {"idle", r.idle},
                                        {"balance", r.balance},
                                        {"received_bytes", r.halo_bytes},
                                        {"gathered_bytes", r.gathered_bytes},
                                        {"pair_velocity_bytes", r.pair_bytes},
                                        {"memory_bytes_rank_0", r.first_memory},
                                        {"memory_bytes_largest_other", r.other_memory},
                                        {"particles_counted", r.whole}};
  return document.dump();
}

}  // namespace gaussdrift::accuracy
