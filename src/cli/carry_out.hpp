// A run from its first step, or from a checkpoint, to its last file.
#pragma once

#include <filesystem>
#include <limits>
#include <optional>
#include <string>

#include "base/communicator.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/error.hpp"
#include "write/checkpoint.hpp"

namespace gaussdrift::cli {

struct RunTask {
  Case asked;  // as it was asked for: its target is told beside what was achieved
  Case spec;   // with the settings that count
  std::filesystem::path folder;
  std::string command;                                           // as it was typed, for provenance.json
  bool force = false;                                            // replace an earlier run in the folder
  bool json = false;                                             // results as JSON on standard output
  int threads = 0;                                               // 0: all
  double stop_after = std::numeric_limits<double>::infinity();   // seconds
  double most_memory = std::numeric_limits<double>::infinity();  // bytes; what would take more is refused
  bool goes_on = false;                                          // from a checkpoint
  std::optional<write::Checkpoint> from{};                       // that one, as far as this rank has it
  std::string past{};                                            // past_of() the case, where it is known
  std::optional<ExitCode> done{};                                // nothing is left to do
  bool changed = false;                                          // going on: the case is another than before
  std::string told{};                                            // lines to be told once nothing is refused any more
};

/// The hash of all that the particles of a case depend on: settings and the bytes of its data. Throws FileError.
std::string past_of(const Case& spec);

/// Runs, explains the errors, writes everything, and then says what came out. All ranks call it together: rank 0 has the
/// folder, the terminal and the signals of the others.
ExitCode carry_out(RunTask task, base::Communicator& ranks);

/// Of a run that died after its last number: makes its page and closes its folder.
ExitCode finish(const Case& spec, const std::filesystem::path& folder);

}  // namespace gaussdrift::cli
