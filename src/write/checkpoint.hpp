// Checkpoints: the state of a run in state/, from which it goes on with the same bits. docs/reliability.md has the
// format. Two alternate, so that one is whole at every moment. Ranks that share a run write and read pieces of them each.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "gaussdrift/particles.hpp"
#include "write/outputs_log.hpp"
#include "write/part_file.hpp"

namespace gaussdrift::write {

/// Seconds. Shorter runs keep no checkpoints unless they are asked for.
constexpr double long_run = 300;

/// Particles, so that threads and ranks share ten million evenly. Readers know nothing of it.
constexpr std::size_t usual_checkpoint_piece = std::size_t{1} << 20;

/// How far a run was.
struct CheckpointFacts {
  double time = 0;
  std::size_t steps = 0, particles = 0;
  double bytes = 0;  // of its files
};

/// What the next checkpoint must not touch, and goes on from.
struct CheckpointTrail {
  std::optional<int> newest;  // of the two
  OutputsMark outputs{};
};

struct Checkpoint {
  CheckpointFacts facts;
  Particles particles;  // on several ranks: some, by their pieces
  std::string state;    // Simulation::state(); on rank 0
  CheckpointTrail trail{};
};

/// Writes the checkpoints of a run.
class CheckpointWriter {
 public:
  struct Options {
    int threads = 1;
    /// Once it says so the disk is not waited for. The checkpoint then survives the end of this process, however it
    /// comes, and is refused after a loss of power unless force_checkpoints() has returned true; the other one is not
    /// touched.
    InHaste in_haste{};
    std::size_t piece_particles = usual_checkpoint_piece;
  };
  /// trail: of the checkpoint that the run goes on from.
  CheckpointWriter(std::filesystem::path folder, CheckpointTrail trail, Options options, base::Communicator& ranks)
      : folder_(std::move(folder)), trail_(std::move(trail)), options_(std::move(options)), ranks_(ranks) {}

  /// Writes a checkpoint in place of the older one of the two. All ranks call it, each with its own particles; a rank
  /// holds one piece at a time beside them. `past`, a hash of all that the particles depend on, and `state` count on rank
  /// 0, and the facts are complete there. Files have the same bytes for any number of ranks and threads. Throws FileError
  /// on all ranks; the newer of the two then stands.
  CheckpointFacts write(const std::string& past, double time, std::size_t steps, const Particles& particles,
                        const std::string& state);

 private:
  std::filesystem::path folder_;
  CheckpointTrail trail_;
  Options options_;
  base::Communicator& ranks_;
};

/// Waits until the disk has the files of all checkpoints of the folder that this rank has written, or until `in_haste`
/// says so. Returns whether it has them. Throws FileError.
bool force_checkpoints(const std::filesystem::path& folder, const InHaste& in_haste = {}, int rank = 0, int ranks = 1);

/// The newest checkpoint that is whole, of a known format and of this past. Why the others are not, in `refused`: one
/// line each, on rank 0. All ranks call it, and each reads some of the pieces. Takes no more memory than the files have
/// bytes, but for the numbers of outputs.
std::optional<Checkpoint> read_checkpoint(const std::filesystem::path& folder, const std::string& past,
                                          std::vector<std::string>& refused, base::Communicator& ranks);

/// "state", the folder of checkpoints in that of a run.
constexpr const char* checkpoints_folder = "state";

/// Files of a checkpoint: what may be removed with a run.
std::vector<std::filesystem::path> checkpoint_files(const std::filesystem::path& folder);

}  // namespace gaussdrift::write
