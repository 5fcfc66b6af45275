// The page about a run, at its end.
#pragma once

#include <filesystem>
#include <string>

#include "cli/owed_files.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::cli {

/// Returns lines for the end of the run: what the page does without. `owed` is told what is missing.
/// `pictures_come_later`: there is no time to draw them.
std::string write_page(const std::filesystem::path& folder, const Case& spec, OwedFiles& owed,
                       bool pictures_come_later = false);

}  // namespace gaussdrift::cli
