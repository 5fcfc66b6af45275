// The data files that a case names, and how they are named elsewhere.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"

namespace gaussdrift::input {

/// Grids and tables that the case reads, in its order; those that a .pvd lists follow it.
std::vector<std::filesystem::path> data_files(const Case& spec);

/// The data file that a case in this folder calls `name`. If none is there, and the case is that of a run, the folder was
/// moved or set aside (earlier/) after the run had begun: then it is looked for where it was. The path that the name says
/// where nothing is found.
std::filesystem::path find_data_file(const std::filesystem::path& case_folder, const std::string& name);

/// What to do if find_data_file() finds nothing, for a run: where the file was. Empty for other cases.
std::string where_data_file_was(const std::filesystem::path& case_folder, const std::string& name);

/// The case with the names of its data files without their folders; its text then is the same wherever they lie.
Case with_bare_names(Case spec);

/// `file` as seen from `folder`: relative, whatever links lead there; absolute where that cannot be.
std::filesystem::path seen_from(const std::filesystem::path& folder, const std::filesystem::path& file);

}  // namespace gaussdrift::input
