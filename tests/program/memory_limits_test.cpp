// Memory that may be taken: what control groups say, and that a run which needs more is refused before it begins.
#include "accuracy/memory_limits.hpp"

#include <gtest/gtest.h>

#include <string>

#include "base/size_text.hpp"
#include "program/program.hpp"

namespace gaussdrift {
namespace {

using accuracy::limits_of_groups, accuracy::MemoryLimit;

void put(const fs::path& file, const std::string& text) {
  fs::create_directories(file.parent_path());
  write_file(file, text);
}

void expect_limits(const ScratchFolder& root, const std::vector<std::pair<std::string, double>>& wanted) {
  const std::vector<MemoryLimit> found = limits_of_groups(root.path());
  ASSERT_EQ(found.size(), wanted.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    EXPECT_EQ(found[i].who, "the control group " + wanted[i].first + " allows");
    EXPECT_EQ(found[i].bytes, wanted[i].second);
  }
}

TEST(LimitsOfGroups, OfVersion2AreThoseOfTheGroupAndOfAllAboveIt) {
  const ScratchFolder root;
  put(root / "proc/self/cgroup", "0::/batch/job 7/step\n");
  put(root / "proc/self/mountinfo",
      "22 1 8:1 / / rw - ext4 /dev/sda1 rw\n"
      "30 22 0:26 / /sys/fs/cgroup rw,nosuid shared:9 master:1 - cgroup2 cgroup2 rw,nsdelegate\n");
  put(root / "sys/fs/cgroup/batch/job 7/step/memory.max", "max\n");
  put(root / "sys/fs/cgroup/batch/job 7/memory.max", "3000000000\n");
  put(root / "sys/fs/cgroup/batch/memory.max", "5000000000\n");
  expect_limits(root, {{"/batch/job 7 (memory.max)", 3e9}, {"/batch (memory.max)", 5e9}});
}

TEST(LimitsOfGroups, OfVersion1AreInAFolderOfTheirOwn) {
  const ScratchFolder root;
  put(root / "proc/self/cgroup", "5:cpu,cpuacct:/other\n4:memory:/slurm/job\n0::/\n");
  put(root / "proc/self/mountinfo",
      "31 22 0:28 / /sys/fs/cgroup rw - tmpfs tmpfs rw,mode=755\n"
      "32 31 0:29 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu,cpuacct\n"
      "35 31 0:32 / /sys/fs/cgroup/memory rw - cgroup cgroup rw,memory\n");
  put(root / "sys/fs/cgroup/memory/memory.limit_in_bytes", "9223372036854771712\n");
  put(root / "sys/fs/cgroup/memory/slurm/job/memory.limit_in_bytes", "2000000000\n");
  put(root / "sys/fs/cgroup/cpu/other/memory.limit_in_bytes", "1\n");
  expect_limits(root,
                {{"/slurm/job (memory.limit_in_bytes)", 2e9}, {"/ (memory.limit_in_bytes)", 9223372036854771712.0}});
}

/// A container sees its own group at the top of the mounted folder, and is told the whole name.
TEST(LimitsOfGroups, AreFoundWhereOnlyAPartIsMounted) {
  const ScratchFolder root;
  put(root / "proc/self/cgroup", "4:memory:/docker/abc/inner\n");
  put(root / "proc/self/mountinfo", "35 31 0:32 /docker/abc /sys/fs/cgroup/memory ro - cgroup cgroup rw,memory\n");
  put(root / "sys/fs/cgroup/memory/memory.limit_in_bytes", "7000000000\n");
  put(root / "sys/fs/cgroup/memory/inner/memory.limit_in_bytes", "6000000000\n");
  expect_limits(root, {{"/inner (memory.limit_in_bytes)", 6e9}, {"/ (memory.limit_in_bytes)", 7e9}});
}

TEST(LimitsOfGroups, AreNoneWhereNothingIsKnown) {
  const ScratchFolder root;
  expect_limits(root, {});
  put(root / "proc/self/cgroup", "nonsense\n0::/../../outside\n");
  put(root / "proc/self/mountinfo", "\n1 2\n30 22 0:26 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n");
  put(root / "outside/memory.max", "5\n");
  expect_limits(root, {});
  put(root / "sys/fs/cgroup/memory.max", "8000\n");
  expect_limits(root, {{"/ (memory.max)", 8000}});
}

TEST(Sizes, AreReadWithTheirUnits) {
  for (const auto& [text, bytes] : {std::pair<const char*, double>{"2 GiB", 2147483648.0},
                                    {"500 MB", 5e8},
                                    {"1.5gb", 1.5e9},
                                    {"3G", 3221225472.0},
                                    {"2e9", 2e9},
                                    {"64 k", 65536}})
    EXPECT_EQ(base::read_size(text), bytes) << text;
  for (const char* text : {"", "GB", "-1 GB", "0", "1 XB", "1 GB x", "nan", "inf MB"})
    EXPECT_FALSE(base::read_size(text)) << text;
}

const std::string many = case_text({.particles = "per_axis = 1500", .evaluate = "per_axis = 1000"});

TEST(Memory, OfARunIsRefusedByAnyLimitBeforeItBegins) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", many);
  for (const std::string verb : {"run", "study"}) {
    const Outcome refused = gaussdrift_in(folder, verb + " a.toml --memory '90 MB'");
    EXPECT_EQ(refused.exit_code, 3) << refused.err;
    for (const char* part : {"the run would take about ", " of memory, and --memory allows 90 MB: ", " particles, ",
                             " grid points", " for the program", "lower particles.per_axis"})
      EXPECT_NE(refused.err.find(part), std::string::npos) << part << " is not in " << refused.err;
    EXPECT_FALSE(fs::exists(folder / "output"));
  }
  const Outcome wrong = gaussdrift_in(folder, "run a.toml --memory 90QB");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("--memory \"90QB\" is no size; give a size such as"), std::string::npos) << wrong.err;
  const Outcome none =
      gaussdrift_in(folder, "run a.toml --memory 1MB --set particles.per_axis=10 --set evaluate.per_axis=5");
  EXPECT_NE(none.err.find("the program itself needs nearly all of it"), std::string::npos) << none.err;
}

TEST(Memory, ThatIsMissingIsToldByCheck) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", many);
  const Outcome check = gaussdrift_in(folder, "check a.toml --memory '90 MB'");
  EXPECT_EQ(check.exit_code, 0) << check.err;
  EXPECT_NE(check.out.find("--memory allows 90 MB of memory, so `run` refuses this case: "), std::string::npos)
      << check.out;
}

TEST(Memory, OfAResumedRunAndOfASumIsLimitedToo) {
  const ScratchFolder folder;
  write_file(folder / "a.toml", small_case);
  EXPECT_EQ(gaussdrift_in(folder, "run a.toml --out r --stop-after 0").exit_code, 7);
  const Outcome refused = gaussdrift_in(folder, "resume r --memory '1 MB'");
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("--memory allows 1 MB"), std::string::npos) << refused.err;
  EXPECT_EQ(gaussdrift_in(folder, "resume r --memory '1 GiB'").exit_code, 0) << "nothing is lost by the refusal";
  write_file(folder / "s.csv", "x,y,weight\n0,0,1\n1,0,1\n");
  const std::string sum = "sum --sources s.csv --sigma 1 --grid=0:1:3000,0:1:3000 --out v.csv --memory ";
  const Outcome large = gaussdrift_in(folder, sum + "'70 MB'");
  EXPECT_EQ(large.exit_code, 3);
  EXPECT_NE(large.err.find("would take 72 MB with the points; at most "), std::string::npos) << large.err;
  EXPECT_FALSE(fs::exists(folder / "v.csv"));
}

}  // namespace
}  // namespace gaussdrift
