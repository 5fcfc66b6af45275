#include "accuracy/memory_limits.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/sysinfo.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

#include "base/printable.hpp"

namespace gaussdrift::accuracy {

namespace {

namespace fs = std::filesystem;

/// Memory as the system counts it against the limits of addresses and of data.
struct Mapped {
  double addresses = 0, data = 0;  // bytes
};

Mapped mapped_by_this_process() {
  std::array<double, 6> pages{};  // size resident shared text lib data
  std::ifstream in("/proc/self/statm");
  for (double& one : pages) in >> one;
  const auto page = static_cast<double>(sysconf(_SC_PAGESIZE));
  return {pages[0] * page, pages[5] * page};
}

double limit_of(int resource) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource_t>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
    return no_limit;
  return static_cast<double>(limit.rlim_cur);
}

/// "rw,memory".
bool lists_memory(const std::string& words) {
  std::istringstream list(words);
  for (std::string word; std::getline(list, word, ',');)
    if (word == "memory") return true;
  return false;
}

/// Where groups are seen: /proc/self/mountinfo has a line for each hierarchy,
/// "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory".
struct Hierarchy {
  std::string top, folder;  // the group at the folder: "/" but where only a part is mounted
  bool version2 = false;
};

std::vector<Hierarchy> hierarchies(const fs::path& root) {
  std::vector<Hierarchy> found;
  std::ifstream mounts(root / "proc/self/mountinfo");
  for (std::string line; std::getline(mounts, line);) {
    std::istringstream words(line);
    std::string skipped, top, folder, kind, source, options;
    for (int i = 0; i < 3; ++i) words >> skipped;
    words >> top >> folder;
    while (words >> skipped && skipped != "-") continue;
    words >> kind >> source >> options;
    if (kind == "cgroup2" || (kind == "cgroup" && lists_memory(options)))
      found.push_back({top, folder, kind == "cgroup2"});
  }
  return found;
}

/// The group of this process in a hierarchy: /proc/self/cgroup has lines as "0::/user" (version 2) and
/// "4:memory:/batch" (version 1).
std::optional<std::string> own_group(const fs::path& root, bool version2) {
  std::ifstream groups(root / "proc/self/cgroup");
  for (std::string line; std::getline(groups, line);) {
    const std::size_t first = line.find(':'), second = line.find(':', first + 1);
    if (first == std::string::npos || second == std::string::npos) continue;
    const std::string kinds = line.substr(first + 1, second - first - 1);
    if (version2 ? kinds.empty() : lists_memory(kinds)) return line.substr(second + 1);
  }
  return std::nullopt;
}

}  // namespace

std::vector<MemoryLimit> limits_of_groups(const fs::path& root) {
  std::vector<MemoryLimit> limits;
  for (const Hierarchy& all : hierarchies(root)) {
    const auto group = own_group(root, all.version2);
    if (!group) continue;
    // As seen from the folder. A group that lies elsewhere is not seen at all; the folder itself is.
    std::string_view below = *group;
    if (all.top != "/" && below.starts_with(all.top)) below.remove_prefix(all.top.size());
    fs::path inside = fs::path(below).relative_path();
    if (inside.string().find("..") != std::string::npos) inside.clear();
    const char* name = all.version2 ? "memory.max" : "memory.limit_in_bytes";
    for (;; inside = inside.parent_path()) {
      double bytes = 0;  // "max" is no number: no limit
      if (std::ifstream(root / fs::path(all.folder).relative_path() / inside / name) >> bytes && bytes >= 0)
        limits.push_back(
            {.who = fmt::format("the control group /{} ({}) allows", base::printable(inside.generic_string()), name),
             .bytes = bytes});
      if (inside.empty()) break;
    }
  }
  return limits;
}

std::vector<MemoryLimit> memory_limits(double asked) {
  const Mapped mapped = mapped_by_this_process();
  const double held = memory_of_this_process();
  std::vector<MemoryLimit> limits = limits_of_groups();
  for (MemoryLimit& limit : limits) limit.taken = held;
  struct sysinfo machine {};
  if (sysinfo(&machine) == 0)
    limits.push_back(
        {"the machine has",
         (static_cast<double>(machine.totalram) + static_cast<double>(machine.totalswap)) * machine.mem_unit, held});
  limits.push_back({"the limit of address space (ulimit -v) allows", limit_of(RLIMIT_AS), mapped.addresses, true});
  limits.push_back({"the limit of data (ulimit -d) allows", limit_of(RLIMIT_DATA), mapped.data, true});
  limits.push_back({"--memory allows", asked, held});
  return limits;
}

MemoryLimit tightest_limit(double asked) {
  const std::vector<MemoryLimit> limits = memory_limits(asked);
  return *std::min_element(limits.begin(), limits.end(),
                           [](const MemoryLimit& a, const MemoryLimit& b) { return a.left() < b.left(); });
}

double memory_of_this_process() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return 1024.0 * static_cast<double>(usage.ru_maxrss);
}

}  // namespace gaussdrift::accuracy
