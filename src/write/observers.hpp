// What a run writes at each output time: ParaView series and the table of numbers.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "sim/frame.hpp"

namespace gaussdrift::write {

/// density.pvd and density/density_0000.vti, ...
std::unique_ptr<Observer> density_files(const std::filesystem::path& folder);

/// particles.pvd and particles/particles_0000.vtp, ...
std::unique_ptr<Observer> particle_files(const std::filesystem::path& folder);

/// series.csv: one row an output; the whole file is written again each time, so it is never half a row. `errors`: with
/// the norms of the error, for runs that have a reference.
std::unique_ptr<Observer> series_table(const std::filesystem::path& folder, int dimension, bool errors);

}  // namespace gaussdrift::write
