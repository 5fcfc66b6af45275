#include "report/run_files.hpp"

#include <cstdint>
#include <fstream>
#include <system_error>

namespace gaussdrift::report {

namespace fs = std::filesystem;

std::string read_file_of_run(const fs::path& file) {
  constexpr std::uintmax_t most_bytes = std::uintmax_t{1} << 30;
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(file, error))) return "";
  const std::uintmax_t size = fs::file_size(file, error);
  if (error || size > most_bytes) return "";
  std::string text(size, '\0');
  if (!std::ifstream(file, std::ios::binary).read(text.data(), static_cast<std::streamsize>(size))) return "";
  return text;
}

}  // namespace gaussdrift::report
