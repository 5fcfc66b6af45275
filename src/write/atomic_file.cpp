#include "write/atomic_file.hpp"

#include <cerrno>
#include <system_error>

#include "write/part_file.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

void write_atomically(const fs::path& file, const std::function<void(std::FILE*)>& write) {
  try {
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
    PartFile part(file);
    write(part.stream());
    part.flush();
    part.take_name(file);
  } catch (const std::system_error& error) {  // also of the file system library
    fail_to_write(file, error.code().value());
  }
}

void write_text(const fs::path& file, std::string_view text) {
  write_atomically(file, [&](std::FILE* part) {
    if (std::fwrite(text.data(), 1, text.size(), part) != text.size())
      throw std::system_error(errno, std::generic_category());
  });
}

}  // namespace gaussdrift::write
