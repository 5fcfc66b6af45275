// The films of a run, made of the frames that it has kept.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/owed_files.hpp"
#include "gaussdrift/case.hpp"

namespace gaussdrift::cli {

/// Throws InputError where another program makes the animation of this case, and is not there.
void refuse_films_without_their_program(const Case& spec);

/// "images/surface.gif", ...; none without an animation.
std::vector<std::string> film_names(const Case& spec);

/// Where the run in the folder has kept frames. Returns a line about the films for the end of the run. Where one cannot be made
/// the frames stay, `owed` knows why, and what can be done.
std::string make_films(const std::filesystem::path& folder, const Case& spec, int threads, OwedFiles& owed);

}  // namespace gaussdrift::cli
