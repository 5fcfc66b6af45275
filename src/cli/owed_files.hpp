// Files that a verb writes once its numbers are known. If one cannot be written, the others and the closing lines still
// are, and the exit code tells.
#pragma once

#include <string>
#include <vector>

#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

class OwedFiles {
 public:
  /// Whether `write` wrote.
  template <class Write>
  bool attempt(const Write& write) {
    try {
      write();
      return true;
    } catch (const FileError& error) {
      missing_.push_back(error.what());
      return false;
    }
  }
  void miss(const std::string& why) { missing_.push_back(why); }
  void miss_for_lack_of_memory(const std::string& why) {
    missing_.push_back(why);
    lacked_memory_ = true;
  }
  /// Why files are missing.
  const std::vector<std::string>& missing() const { return missing_; }
  ExitCode code() const { return missing_.empty() ? ExitCode::ok : lacked_memory_ ? ExitCode::input : ExitCode::files; }

 private:
  std::vector<std::string> missing_;
  bool lacked_memory_ = false;
};

}  // namespace gaussdrift::cli
