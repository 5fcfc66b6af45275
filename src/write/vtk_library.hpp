// The VTK that runs: its version, its log.
#pragma once

#include <string>

namespace gaussdrift::write {

/// "9.1.0"
std::string vtk_version();

/// Silences VTK's own log: what is wrong is told by exceptions. VTK starts no threads of its own: where there are none
/// to be had it gives up.
void prepare_vtk();

}  // namespace gaussdrift::write
