// Runs on several ranks that are disturbed: one rank is prepared for a fault, or something happens while they run.
#pragma once

#include <chrono>
#include <string>
#include <thread>

#include "ranks/mpirun.hpp"

namespace gaussdrift {

/// A command for mpirun: `prepare` is done on one rank alone before the program starts there. Each rank leaves the number
/// of its process in rank_R.pid.
inline std::string with_one_rank(int rank, const std::string& prepare, const std::string& arguments) {
  return "sh -c 'echo $$ > rank_$OMPI_COMM_WORLD_RANK.pid; if [ $OMPI_COMM_WORLD_RANK = " + std::to_string(rank) +
         " ]; then " + (prepare.empty() ? ":" : prepare) + "; fi; exec " PROGRAM " " + arguments + "'";
}

/// Starts `command` and does `then` as soon as `file` is there; the outcome is that of the command. Its process is $it.
inline Outcome when_there(const ScratchFolder& folder, const std::string& file, const std::string& command,
                          const std::string& then) {
  return outcome_of(folder, command + " & it=$!; i=0; until [ -e " + file +
                                " ] || [ $i -ge 900 ]; do sleep 0.02; i=$((i + 1)); done; " + then + "; wait $it");
}

/// Processes that work in this folder still. They get some seconds to end, a tenth for each try.
inline std::string left_in(const ScratchFolder& folder, int most_tries = 100) {
  std::string left;
  for (int tries = 0; tries < most_tries; ++tries) {
    left.clear();
    std::error_code ignored;
    for (const auto& entry : fs::directory_iterator("/proc", ignored))
      if (fs::read_symlink(entry.path() / "cwd", ignored) == fs::canonical(folder.path()))
        left += entry.path().filename().string() + " " + read_file(entry.path() / "cmdline") + "\n";
    if (left.empty()) break;
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
  }
  return left;
}

}  // namespace gaussdrift
