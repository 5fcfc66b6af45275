// What libFuzzer and the replay of the corpus call. A target is one file <name>_target.cpp:
//
//   FUZZ_TARGET(table) { read(text); }     // std::string_view text: the input
//
// A target lets through only what the program answers with an exit code for wrong input. All else is a finding.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace gaussdrift::fuzz {

struct Target {
  const char* name;
  void (*run)(std::string_view);
};

/// Those of this program.
inline std::vector<Target>& targets() {
  static std::vector<Target> all;
  return all;
}

struct Registration {
  Registration(const char* name, void (*run)(std::string_view)) { targets().push_back({name, run}); }
};

/// A folder of this process, in memory where the system has one there. It goes with the process.
class Folder {
 public:
  Folder();
  ~Folder();
  const std::filesystem::path& path() const { return path_; }
  /// Writes the file, with the folder that it is in, and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view text) const;

 private:
  std::filesystem::path path_;
};

/// The one of this process.
const Folder& folder();

/// Several files in one input: each after a line "=== NAME" of its own.
class Bundle {
 public:
  explicit Bundle(std::string_view text);
  /// Empty if there is none of that name.
  std::string_view operator[](std::string_view name) const;
  bool has(std::string_view name) const;

 private:
  std::vector<std::pair<std::string_view, std::string_view>> files_;
};

}  // namespace gaussdrift::fuzz

#define FUZZ_TARGET(name)                                                                \
  static void fuzz_##name(std::string_view text);                                        \
  static const ::gaussdrift::fuzz::Registration registration_##name(#name, fuzz_##name); \
  static void fuzz_##name(std::string_view text)
