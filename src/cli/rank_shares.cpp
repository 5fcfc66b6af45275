#include "cli/rank_shares.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "base/counted.hpp"
#include "base/size_text.hpp"

namespace gaussdrift::cli {

std::vector<RankShare> gather_shares(base::Communicator& ranks, double seconds) {
  std::vector<RankShare> shares;
  if (ranks.size() == 1) return shares;
  const RankShare own{seconds, static_cast<double>(ranks.traffic().sent)};
  for (const base::Bytes& bytes : ranks.gather(base::to_bytes(std::span(&own, 1))))
    shares.push_back(base::from_bytes<RankShare>(bytes).front());
  return shares;
}

std::string shares_text(const std::vector<RankShare>& shares, int hosts) {
  if (shares.empty()) return "";
  double all = 0, busiest = 0, sent = 0;
  for (const RankShare& share : shares) {
    all += share.seconds, sent += share.sent;
    busiest = std::max(busiest, share.seconds);
  }
  const double mean = all / static_cast<double>(shares.size());
  return fmt::format("ranks  {} on {}: the busiest took {:.2f} times the mean processor time, {} sent\n", shares.size(),
                     base::counted(static_cast<std::size_t>(hosts), "host"), mean > 0 ? busiest / mean : 1,
                     base::size_text(sent));
}

}  // namespace gaussdrift::cli
