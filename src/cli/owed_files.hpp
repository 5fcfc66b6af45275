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
  /// Why files are missing.
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  std::vector<std::string> missing_;
};

}  // namespace gaussdrift::cli
