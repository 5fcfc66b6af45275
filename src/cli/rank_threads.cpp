#include "cli/rank_threads.hpp"

#include <sched.h>

#include <algorithm>
#include <cstdlib>
#include <set>

#include "base/default_threads.hpp"

namespace gaussdrift::cli {

namespace {

/// Empty if the system does not tell.
std::vector<int> own_cores() {
  constexpr int most = 1 << 14;
  std::vector<int> cores;
  cpu_set_t* const set = CPU_ALLOC(most);
  const std::size_t size = CPU_ALLOC_SIZE(most);
  if (set && sched_getaffinity(0, size, set) == 0)
    for (int core = 0; core < most; ++core)
      if (CPU_ISSET_S(core, size, set)) cores.push_back(core);
  if (set) CPU_FREE(set);
  return cores;
}

}  // namespace

int threads_of_rank(base::Communicator& ranks, const std::vector<int>& cores) {
  std::vector<int> own{ranks.host()};
  own.insert(own.end(), cores.begin(), cores.end());
  std::vector<std::vector<int>> all;  // by rank: host, cores
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(own))) all.push_back(base::from_bytes<int>(bytes));
  std::vector<base::Bytes> answers(static_cast<std::size_t>(ranks.size()));
  for (std::size_t rank = 0; rank < all.size(); ++rank) {
    const std::set<int> mine(all[rank].begin() + 1, all[rank].end());
    const auto shares = std::count_if(all.begin(), all.end(), [&](const std::vector<int>& other) {
      return other[0] == all[rank][0] &&
             std::any_of(other.begin() + 1, other.end(), [&](int core) { return mine.count(core) > 0; });
    });
    const int threads = std::max(1, static_cast<int>(mine.size()) / std::max(1, static_cast<int>(shares)));
    answers[rank] = base::to_bytes(std::vector<int>{threads});
  }
  return base::from_bytes<int>(ranks.exchange(answers)[0])[0];
}

void share_cores(base::Communicator& ranks) {
  const int threads = threads_of_rank(ranks, own_cores());
  if (!std::getenv("OMP_NUM_THREADS")) base::limit_default_threads(threads);
}

}  // namespace gaussdrift::cli
