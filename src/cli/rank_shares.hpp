// How evenly the ranks of a run worked.
#pragma once

#include <string>
#include <vector>

#include "base/communicator.hpp"

namespace gaussdrift::cli {

/// Of the work of one rank.
struct RankShare {
  double seconds = 0;  // of its processor
  double sent = 0;     // bytes
};

/// Those of all ranks on rank 0, in their order; empty elsewhere, and where there is one rank alone. All call it.
std::vector<RankShare> gather_shares(base::Communicator& ranks, double seconds);

/// One line; empty if there are no shares.
std::string shares_text(const std::vector<RankShare>& shares, int hosts);

}  // namespace gaussdrift::cli
