// The data files that a case names, and how they are named elsewhere.
#pragma once

#include <filesystem>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::input {

/// Grids and tables that the case reads, in its order; those that a .pvd lists follow it.
std::vector<std::filesystem::path> data_files(const Case& spec);

/// The case with the names of its data files without their folders; its text then is the same wherever they lie.
Case with_bare_names(Case spec);

/// `file` as seen from `folder`: relative, whatever links lead there; absolute where that cannot be.
std::filesystem::path seen_from(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace gaussdrift::input
