// How many threads a rank takes unless --threads or OMP_NUM_THREADS says it: ranks of a machine share its cores.
#pragma once

#include <vector>

#include "base/communicator.hpp"

namespace gaussdrift::cli {

/// The cores that this rank may use, divided by the ranks of its host that may use one of them, itself among them. At
/// least 1. All ranks call it.
int threads_of_rank(base::Communicator& ranks, const std::vector<int>& cores);

/// The same for the cores that the system lets this process use, set as the default.
void share_cores(base::Communicator& ranks);

}  // namespace gaussdrift::cli
