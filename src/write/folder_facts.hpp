// What the files of a folder tell about the run or the study that left them. The folder may be a stranger's.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>

#include "write/own_files.hpp"

namespace gaussdrift::write {

// All of these throw FileError with place, reason and remedy where a file is damaged.

/// Whether summary.json says that the run is complete. One of an older version was written at the end, and does not say.
bool says_complete(const std::filesystem::path& folder);

/// "running", "complete", ... of status.json; empty if there is none: earlier versions wrote none.
std::string state_of_folder(const std::filesystem::path& folder);

/// How many outputs are whole, by status.json; 0 if there is none.
std::size_t outputs_of_folder(const std::filesystem::path& folder);

/// Of the case as it was run, from provenance.json; empty if there is none.
std::string name_of_run(const std::filesystem::path& folder);

/// What a finished study wrote into the folder, by the names that its study.json tells. One that was interrupted has no
/// list.
OwnFiles files_of_study(const std::filesystem::path& folder);

}  // namespace gaussdrift::write
