// What gathers the frames of a page while a run goes on.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"
#include "report/reel.hpp"

namespace gaussdrift::report {

/// Bytes that a reel may have on a page of so many megabytes.
std::size_t most_reel_bytes(const PageSpec& page);

/// Of each output the density, `rho`, its `error` where the exact density is known, fields beside it (of vectors their
/// lengths, and the arrows of the velocity), and some of the particles. `has_particles`: an output has all of them, also
/// where ranks share the run.
std::unique_ptr<Observer> reel_series(std::shared_ptr<Reel> reel, const Case& spec, bool has_particles);

/// The same from the density files of a run's folder, as far as they have it; empty where there are none. Throws
/// FileError.
Reel reel_from_files(const std::filesystem::path& folder, std::size_t most_bytes);

}  // namespace gaussdrift::report
