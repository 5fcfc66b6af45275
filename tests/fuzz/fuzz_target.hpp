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
  /// Writes the file and returns its path.
  std::filesystem::path write(const std::string& name, std::string_view text) const {
    const std::filesystem::path file = path_ / name;
    std::ofstream(file, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// The one of this process.
const Folder& folder();

}  // namespace gaussdrift::fuzz

#define FUZZ_TARGET(name)                                                                \
  static void fuzz_##name(std::string_view text);                                        \
  static const ::gaussdrift::fuzz::Registration registration_##name(#name, fuzz_##name); \
  static void fuzz_##name(std::string_view text)
