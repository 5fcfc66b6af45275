// What limits the memory of this process: the machine, its control group, its limits (ulimit), and what the user says.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace gaussdrift::accuracy {

constexpr double no_limit = std::numeric_limits<double>::infinity();

struct MemoryLimit {
  std::string who;          // "the machine has", "--memory allows": a size follows
  double bytes = no_limit;  // that the process may take
  double taken = 0;         // of them, so far
  bool of_process = false;  // else other processes take from it, too

  double left() const { return bytes - taken; }
};

/// Of a control group and of all above it, in version 2 (memory.max) and version 1 (memory.limit_in_bytes) of their
/// files. `root` is the folder in which /proc and /sys lie, for tests.
std::vector<MemoryLimit> limits_of_groups(const std::filesystem::path& root = "/");

/// All that there are. asked: --memory, in bytes.
std::vector<MemoryLimit> memory_limits(double asked = no_limit);

/// The one that leaves least.
MemoryLimit tightest_limit(double asked = no_limit);

/// Bytes that this process holds, or has held.
double memory_of_this_process();

}  // namespace gaussdrift::accuracy
