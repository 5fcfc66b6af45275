// What looks at the outputs of a run and writes them: tables, files for ParaView, pictures.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gaussdrift/simulation.hpp"

namespace gaussdrift::cli {

/// On the first rank. Where a core is free it draws pictures beside the run. `later` gets lines of warning for the end of the run, and has to live as long.
void add_observers(Simulation& simulation, const Case& spec, const std::filesystem::path& folder, bool core_is_free,
                   std::vector<std::string>& later);

/// On the others: each writes the pieces that it has.
void observe_pieces(Simulation& simulation, const Case& spec, const std::filesystem::path& folder);

}  // namespace gaussdrift::cli
