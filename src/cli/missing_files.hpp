// Files of earlier outputs that are gone from the folder of a run.
#pragma once

#include <cstddef>
#include <filesystem>

#include "gaussdrift/case.hpp"

namespace gaussdrift::cli {

/// Warns of files and pictures of the first outputs of the case that are not there: how many, the first one, and what can
/// be done. A run goes on without them.
void tell_missing_files(const Case& spec, const std::filesystem::path& folder, std::size_t outputs);

}  // namespace gaussdrift::cli
