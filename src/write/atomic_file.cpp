#include "write/atomic_file.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>

#include "base/seam.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

void write_atomically(const fs::path& file, const std::function<void(std::FILE*)>& write, const InHaste& in_haste) {
  try {
    if (file.has_parent_path()) make_folder(file.parent_path(), in_haste);
    PartFile part(file);
    write(part.stream());
    part.flush(in_haste);
    part.take_name(file, in_haste);
  } catch (const std::system_error& error) {  // also of the file system library
    fail_to_write(file, error.code().value());
  }
}

void write_text(const fs::path& file, std::string_view text, const InHaste& in_haste) {
  const auto write = [&](std::FILE* part) {
    constexpr std::size_t piece = 1 << 24;
    for (std::size_t first = 0; first < text.size(); first += piece) {
      base::seam();
      const std::size_t size = std::min(piece, text.size() - first);
      if (std::fwrite(text.data() + first, 1, size, part) != size)
        throw std::system_error(errno, std::generic_category());
    }
  };
  write_atomically(file, write, in_haste);
}

}  // namespace gaussdrift::write
