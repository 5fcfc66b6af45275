// Checkpoints: the state of a run in state/, from which it goes on with the same bits. docs/reliability.md has the
// format. Two alternate, so that one is whole at every moment.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/particles.hpp"
#include "write/part_file.hpp"

namespace gaussdrift::write {

/// Seconds. Shorter runs keep no checkpoints unless they are asked for.
constexpr double long_run = 300;

/// How far a run was.
struct CheckpointFacts {
  double time = 0;
  std::size_t steps = 0, particles = 0;
  double bytes = 0;  // of its files
};

struct Checkpoint {
  CheckpointFacts facts;
  Particles particles;
  std::string state;  // Simulation::state()
};

/// Writes a checkpoint in place of the older one of the two. `past`: a hash of all that the particles depend on.
/// Throws FileError; the newer of the two then stands.
/// Once `in_haste` says so the disk is not waited for. The checkpoint then survives the end of this process, however it
/// comes, and is refused after a loss of power unless force_checkpoints() has returned true; the other one is not
/// touched. Files are written by `threads` threads.
CheckpointFacts write_checkpoint(const std::filesystem::path& folder, const std::string& past, double time,
                                 std::size_t steps, const Particles& particles, const std::string& state,
                                 int threads = 1, const InHaste& in_haste = {});

/// Waits until the disk has all checkpoints of the folder, or until `in_haste` says so. Returns whether it has them.
/// Throws FileError.
bool force_checkpoints(const std::filesystem::path& folder, const InHaste& in_haste = {});

/// The newest checkpoint that is whole, of this format and of this past. Why the others are not, in `refused`: one line
/// each. Takes no more memory than the files have bytes.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& folder, const std::string& past,
                                          std::vector<std::string>& refused);

/// Bytes of a checkpoint.
double bytes_of_checkpoint(const Particles& particles);

/// "state", the folder of checkpoints in that of a run.
constexpr const char* checkpoints_folder = "state";

/// Files of a checkpoint: what may be removed with a run.
std::vector<std::filesystem::path> checkpoint_files(const std::filesystem::path& folder);

}  // namespace gaussdrift::write
