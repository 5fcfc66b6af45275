// Decides when a run writes a checkpoint, and counts what that costs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "base/stopwatch.hpp"
#include "gaussdrift/simulation.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift::cli {

class CheckpointKeeper {
 public:
  /// `asked`: seconds between two, 0 for none, empty for the default: about every minute, and less often where that
  /// would take more than a fiftieth of the time, once a run is seen to take more than five minutes.
  /// `past` gives the hash of what the particles depend on; asked for once, and only if something is written.
  /// `resumed`: the run goes on from a checkpoint, and keeps one of its end.
  /// `trail`: of the checkpoint that the run goes on from. Every rank has a keeper; that of rank 0 decides.
  CheckpointKeeper(std::filesystem::path folder, std::function<std::string()> past, std::optional<double> asked,
                   bool resumed, write::CheckpointWriter::Options options, write::CheckpointTrail trail,
                   base::Communicator& ranks);

  /// To be called between steps: whether it is time to write one. So it is at the end of a run that keeps checkpoints.
  bool is_time(const Progress& progress);

  /// Whether the case wants checkpoints, and the last one is not of this moment.
  bool is_wanted(double time, std::size_t steps, std::size_t outputs) const;

  /// Writes one, whatever the time. All ranks call it, each with its own particles; what else there is counts on rank 0.
  /// Throws FileError on all of them.
  void write(double time, std::size_t steps, std::size_t outputs, const Particles& particles, const std::string& state);

  /// Waits until the disk has what this rank has of the checkpoints, or until `in_haste` says so. Throws FileError.
  void force(const write::InHaste& in_haste = {});

  std::size_t written() const { return written_; }
  double seconds() const { return seconds_; }  // of all
  const write::CheckpointFacts& last() const { return last_; }

 private:
  bool is_due(const Progress& progress) const;

  std::filesystem::path folder_;
  std::function<std::string()> past_;
  std::string hash_;  // what it said
  std::optional<double> asked_;
  bool resumed_;
  write::InHaste in_haste_;
  base::Communicator& ranks_;
  write::CheckpointWriter writer_;
  bool on_disk_;             // all that there is of this rank
  std::size_t outputs_ = 0;  // in the last one
  base::Stopwatch since_start_, since_last_;
  std::optional<double> begun_at_;  // time of the scene
  std::size_t written_ = 0;
  double seconds_ = 0, last_seconds_ = 0;
  write::CheckpointFacts last_;
};

}  // namespace gaussdrift::cli
