// One process at a time writes into a folder of results.
#pragma once

#include <filesystem>
#include <string>

namespace gaussdrift::write {

/// Held while this object lives. It ends with the process, however that ends. On file systems without locks it holds
/// nothing.
class FolderLock {
 public:
  /// Makes the folder if it is not there, and removes what killed processes left in it and in the folders in it. Throws
  /// FileError, naming the process, where another one holds it.
  explicit FolderLock(std::filesystem::path folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::filesystem::path file_;
  int descriptor_ = -1;
};

/// Whether a process, or this one, holds the lock of a folder.
bool is_in_use(const std::filesystem::path& folder);

/// The name of the file that is locked.
constexpr const char* lock_name = ".gaussdrift.lock";

/// "host", as far as the system tells.
std::string host_name();

}  // namespace gaussdrift::write
