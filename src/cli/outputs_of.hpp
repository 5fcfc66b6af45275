// The densities that a run has written, for the verbs that look at them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "read/written_run.hpp"

namespace gaussdrift::cli {

/// Of the folder of a run, or the one of a file. Throws FileError if there are none.
std::vector<read::WrittenOutput> outputs_of(const std::filesystem::path& place, bool locked = false);

/// The arrays that density files may have: the density, what it is compared with, and `output.fields`.
std::vector<std::string> arrays_of_outputs();

/// Throws CommandLineError if --field names none of them.
void check_array(const std::string& field);

/// Says on standard error that the run in the folder is not complete, and whether somebody goes on with it. `locked`: this
/// process holds the lock, so nobody does. Throws FileError if summary.json is damaged.
void tell_if_unfinished(const std::filesystem::path& folder, bool locked);

}  // namespace gaussdrift::cli
