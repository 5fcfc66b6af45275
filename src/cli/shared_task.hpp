// What rank 0 has to do, told to the ranks that help it.
#pragma once

#include <functional>

#include "base/communicator.hpp"
#include "cli/carry_out.hpp"

namespace gaussdrift::cli {

/// Rank 0 makes the task; all ranks get what they need of it: the case, threads, and whether it goes on.
RunTask shared_task(base::Communicator& ranks, const std::function<RunTask()>& make);

}  // namespace gaussdrift::cli
