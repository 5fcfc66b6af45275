// The VTK that runs: its version, its log.
#pragma once

#include <string>

namespace gaussdrift::write {

/// "9.1.0"
std::string vtk_version();

/// Silences VTK's own log: what is wrong is told by exceptions.
void silence_vtk();

}  // namespace gaussdrift::write
