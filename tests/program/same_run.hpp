// Compares the folders of two runs of one case: all that does not depend on the clock has the same bits.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <string>

#include "scratch_folder.hpp"

namespace gaussdrift {

/// Files of a run that hold seconds, or the moment of the run.
inline bool has_times(const std::string& name) {
  static const std::set<std::string> names{"series.csv",  "summary.json", "log.txt",    "provenance.json",
                                           "status.json", "report.html",  "report.json"};
  return names.contains(name) || name.starts_with("state/") || name.starts_with(".");
}

/// All files with their bytes; of series.csv the columns before the seconds.
inline std::map<std::string, std::string> bits_of(const std::filesystem::path& folder) {
  namespace fs = std::filesystem;
  std::map<std::string, std::string> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    const std::string name = fs::relative(entry.path(), folder).generic_string();
    if (entry.is_regular_file() && !has_times(name)) files[name] = read_file(entry.path());
  }
  std::istringstream rows(read_file(folder / "series.csv"));
  for (std::string row; std::getline(rows, row);)
    files["series.csv"] += row.substr(0, row.rfind(',', row.rfind(',') - 1)) + "\n";
  return files;
}

inline void expect_same(const std::filesystem::path& whole, const std::filesystem::path& other) {
  const auto a = bits_of(whole), b = bits_of(other);
  for (const auto& [name, bytes] : a) {
    ASSERT_TRUE(b.contains(name)) << name;
    EXPECT_TRUE(b.at(name) == bytes) << name << " differs";
  }
  EXPECT_EQ(a.size(), b.size());
}

}  // namespace gaussdrift
