#include <unistd.h>

#include "fuzz_target.hpp"

namespace gaussdrift::fuzz {

namespace fs = std::filesystem;

Folder::Folder() {
  std::error_code error;
  const fs::path memory = "/dev/shm";
  path_ = (fs::is_directory(memory, error) && access(memory.c_str(), W_OK) == 0 ? memory : fs::temp_directory_path()) /
          ("gaussdrift_fuzz_" + std::to_string(getpid()));
  fs::create_directories(path_);
}

Folder::~Folder() {
  std::error_code error;
  fs::remove_all(path_, error);
}

const Folder& folder() {
  static const Folder one;
  return one;
}

}  // namespace gaussdrift::fuzz
