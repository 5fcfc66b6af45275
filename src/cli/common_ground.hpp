// What ranks need to have in common, looked at before a run writes anything.
#pragma once

#include <filesystem>
#include <string>

#include "base/communicator.hpp"

namespace gaussdrift::cli {

/// Throws FileError on all ranks where one of them does not see the files that rank 0 makes where the folder will be.
/// `folder` counts on rank 0.
void check_that_all_see(base::Communicator& ranks, const std::filesystem::path& folder);

/// What the last digits of a result depend on, beside the case: "avx2, C library 2.36".
std::string arithmetic_here();

/// A line of warning on rank 0, where ranks differ in that; else empty. `own`: that of this rank.
std::string warning_of_different_arithmetic(base::Communicator& ranks, const std::string& own);

}  // namespace gaussdrift::cli
