// The memory and disk space of a run, estimated from its numbers alone.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "accuracy/trial.hpp"
#include "gaussdrift/case.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::accuracy {

using write::Extent;

/// Bytes that a run takes beyond those of the program and the data of the case, when it takes most: by what they grow
/// with.
struct RunMemory {
  double particles = 0, grid = 0, pictures = 0;

  double all() const { return particles + grid + pictures; }
};

/// Measured over the cases and sizes of tests/program/footprint_test.cpp: with the program right within a factor of 1.3
/// for what is above 20 MB.
RunMemory memory_of_run(const Case& spec, const Extent& extent);

/// The columns of a particle in memory and in a checkpoint.
double bytes_of_particle(const Case& spec);

/// At one stage of a run, or on several ranks.
RunMemory operator+(const RunMemory& a, const RunMemory& b);

/// In how many files an output has so many particles; none where effects change their number during the run.
std::optional<std::size_t> pieces_of_particles(const Case& spec, std::size_t particles);

/// The particles at most: those that effects add are found by steps of a part of them.
double particles_at_most(const Case& spec, Trial& trial);

/// "3.9 GB for 2.65e+08 particles, 80 MB for the program". program: bytes that it takes itself.
std::string what_memory_is_for(const RunMemory& run, double program, const Extent& extent);
/// "lower particles.per_axis, or set output.images = []".
std::string how_to_lower(const RunMemory& run, double program);

/// Bytes of all files of a run that takes about `seconds`, at most: with two checkpoints, where it writes some.
double disk_of_run(const Case& spec, const Extent& extent, double seconds);
/// The most that it takes while it runs: densities for pictures may be kept until the end.
double most_disk_of_run(const Case& spec, const Extent& extent, double seconds);

}  // namespace gaussdrift::accuracy
