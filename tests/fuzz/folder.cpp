#include <unistd.h>

#include <algorithm>

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

fs::path Folder::write(const std::string& name, std::string_view text) const {
  fs::path file = path_ / name;
  if (!fs::exists(file.parent_path())) fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary).write(text.data(), static_cast<std::streamsize>(text.size()));
  return file;
}

Bundle::Bundle(std::string_view text) {
  constexpr std::string_view mark = "=== ";
  std::size_t begin = text.starts_with(mark) ? 0 : text.npos;
  while (begin != text.npos) {
    const std::size_t name = begin + mark.size(), line = std::min(text.find('\n', name), text.size());
    const std::size_t first = std::min(line + 1, text.size()), next = text.find("\n=== ", first == 0 ? 0 : first - 1);
    const std::size_t last = std::max(first, std::min(next, text.size()));
    files_.emplace_back(text.substr(name, line - name), text.substr(first, last - first));
    begin = next == text.npos ? next : next + 1;
  }
}

bool Bundle::has(std::string_view name) const {
  return std::any_of(files_.begin(), files_.end(), [&](const auto& file) { return file.first == name; });
}

std::string_view Bundle::operator[](std::string_view name) const {
  const auto found = std::find_if(files_.begin(), files_.end(), [&](const auto& file) { return file.first == name; });
  return found == files_.end() ? std::string_view() : found->second;
}

const Folder& folder() {
  static const Folder one;
  return one;
}

}  // namespace gaussdrift::fuzz
