#include "accuracy/ranks_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "accuracy/footprint.hpp"
#include "accuracy/memory_limits.hpp"
#include "accuracy/rank_forecast.hpp"
#include "accuracy/trial.hpp"
#include "base/broadcast.hpp"
#include "base/counted.hpp"
#include "base/size_text.hpp"
#include "base/state_bytes.hpp"
#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/error.hpp"
#include "sim/borders/edges.hpp"
#include "sim/releases.hpp"
#include "write/folder_lock.hpp"

namespace gaussdrift::accuracy {

namespace {

constexpr std::size_t trial_particles = 100'000;

/// A limit, and the ranks that take from it together.
struct Shared {
  MemoryLimit limit;
  std::string host;
  std::vector<std::size_t> ranks;
};

/// What a rank says of its memory.
struct RankMemory {
  int host = 0;
  std::string name;  // of the host
  double held = 0;   // bytes, by the program
  std::vector<MemoryLimit> limits;
};

void pass(base::StateBytes& bytes, RankMemory& rank) {
  bytes(rank.host, rank.name, rank.held);
  std::uint64_t count = rank.limits.size();
  bytes(count);
  rank.limits.resize(count);
  for (MemoryLimit& limit : rank.limits) bytes(limit.who, limit.bytes, limit.taken, limit.of_process);
}

std::vector<RankMemory> gathered(double asked, base::Communicator& ranks) {
  RankMemory own{ranks.host(), write::host_name(), memory_of_this_process(), memory_limits(asked)};
  base::StateBytes said;
  pass(said, own);
  std::vector<RankMemory> all;
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(said.written()))) {
    const std::string text = base::to_text(bytes);
    base::StateBytes heard(text);
    pass(heard, all.emplace_back());
  }
  return all;
}

/// Limits with the same words on one host are one, but for those of processes.
std::vector<Shared> shared_limits(const std::vector<RankMemory>& all) {
  std::map<std::pair<int, std::string>, Shared> by_words;
  for (std::size_t rank = 0; rank < all.size(); ++rank)
    for (const MemoryLimit& limit : all[rank].limits) {
      if (limit.bytes >= no_limit) continue;
      const std::string words = limit.of_process ? fmt::format("{} of {}", limit.who, rank) : limit.who;
      Shared& shared = by_words.try_emplace({all[rank].host, words}, Shared{limit, all[rank].name, {}}).first->second;
      if (!shared.ranks.empty()) shared.limit.taken += limit.taken;
      shared.limit.bytes = std::min(shared.limit.bytes, limit.bytes);
      shared.ranks.push_back(rank);
    }
  std::vector<Shared> limits;
  for (auto& [words, shared] : by_words) limits.push_back(std::move(shared));
  return limits;
}

/// The limit that is exceeded most; null: all is well.
const Shared* exceeded(const std::vector<Shared>& limits, const std::vector<RunMemory>& memory) {
  const Shared* worst = nullptr;
  double most = 0;
  for (const Shared& shared : limits) {
    double needed = 0;
    for (const std::size_t rank : shared.ranks) needed += memory[rank].all();
    const double missing = needed - shared.limit.left();
    if (missing >= most) worst = &shared, most = missing;
  }
  return worst;
}

/// More than any rank can take.
RunMemory at_most(const Case& spec, double lattice_points) {
  return memory_of_run(spec, {.lattice_points = lattice_points,
                              .particles = 2 * lattice_points + particles_released(spec, 1),
                              .grid_points = static_cast<double>(evaluation_lattice(spec).size()),
                              .compared_everywhere = spec.reference.kind != ReferenceSpec::Kind::none});
}

std::vector<RunMemory> predicted(const Case& spec, int threads, int ranks) {
  try {
    Trial trial = make_trial(spec, trial_particles, threads);
    return forecast_ranks(spec, particles_at_most(spec, trial), 0, ranks).memory;
  } catch (const InputError&) {
    return {};  // the run will say the same
  }
}

[[noreturn]] void refuse(const Shared& shared, const std::vector<RunMemory>& memory,
                         const std::vector<RankMemory>& told) {
  RunMemory together;
  double programs = 0;
  for (const std::size_t rank : shared.ranks) together = together + memory[rank], programs += told[rank].held;
  const bool one = shared.ranks.size() == 1;
  const std::string who = one ? fmt::format("rank {} of the run", shared.ranks.front())
                              : base::counted(shared.ranks.size(), "rank") + " of the run";
  throw InputError(fmt::format(
      "{} would take about {} of memory on {}{}, and {} {}: {} for particles, {} for grid points and pictures, {} for "
      "{}; start the ranks on more hosts, or {}",
      who, base::size_text(together.all() + programs), shared.host, one ? "" : " together", shared.limit.who,
      base::size_text(shared.limit.bytes), base::size_text(together.particles),
      base::size_text(together.grid + together.pictures), base::size_text(programs),
      one ? "the program" : "the programs", how_to_lower(together, programs)));
}

}  // namespace

void refuse_what_does_not_fit(const Case& spec, int threads, double asked, base::Communicator& ranks) {
  if (ranks.size() == 1) return gaussdrift::refuse_what_does_not_fit(spec, threads, asked);
  base::broadcast_values(ranks, [&](base::StateBytes& bytes) { bytes(asked); });  // rank 0 alone may know it
  const std::vector<RankMemory> of_ranks = gathered(asked, ranks);
  ranks.agree_on([&] {
    if (ranks.rank() != 0) return;
    const std::vector<Shared> limits = shared_limits(of_ranks);
    const Domain& domain = spec.domain;
    const Lattice lattice = seeding_lattice(domain, spec.particles.per_axis);
    const auto count = static_cast<std::size_t>(ranks.size());
    if (!exceeded(limits, std::vector<RunMemory>(count, at_most(spec, static_cast<double>(lattice.size()))))) return;
    const std::vector<RunMemory> memory = predicted(spec, threads, ranks.size());
    if (memory.empty()) return;
    if (const Shared* limit = exceeded(limits, memory)) refuse(*limit, memory, of_ranks);
  });
}

}  // namespace gaussdrift::accuracy
