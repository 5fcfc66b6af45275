// The folder of a run. It is made, checked and emptied of an older run before anything is computed.
#pragma once

#include <filesystem>

#include "gaussdrift/case.hpp"

namespace gaussdrift::write {

/// Makes `folder` ready for a run. A folder that is not empty is refused unless `force` and it holds an earlier
/// run, whose files (and nothing else) are then removed. Throws FileError with the remedy.
void prepare_run_folder(const std::filesystem::path& folder, bool force);

/// case.toml (as it was), run.toml (resolved), view.py (opens the series in ParaView). Throws FileError.
void write_run_inputs(const std::filesystem::path& folder, const Case& spec, const std::string& resolved);

}  // namespace gaussdrift::write
