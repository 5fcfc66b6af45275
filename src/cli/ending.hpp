// How the program ends: what it says about an error, and that all ranks leave with the same exit code.
#pragma once

#include <functional>

#include "base/communicator.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

/// Does the work of this rank. An error that is this rank's alone, or of which all have heard in agree(), is told once,
/// by rank 0. Any other on one of several ranks ends all of them at once, since they may be waiting for it. Returns
/// the exit code, the same on all ranks; all text is out by then.
int end_of(base::Communicator& ranks, const std::function<ExitCode()>& work);

}  // namespace gaussdrift::cli
