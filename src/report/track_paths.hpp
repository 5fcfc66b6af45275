// The tracks of a run as its table has them, for a picture.
#pragma once

#include <filesystem>
#include <vector>

#include "render/panel.hpp"

namespace gaussdrift::report {

/// Places x and y of up to 200 tracks, evenly chosen, with up to a thousand places each. Empty where the folder has no
/// table, or one that no run has written.
std::vector<render::PlaneLine> track_paths(const std::filesystem::path& folder);

}  // namespace gaussdrift::report
