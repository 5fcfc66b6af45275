#include "write/outputs_log.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <string_view>
#include <system_error>

#include "write/checkpoint.hpp"
#include "write/system_failure.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

constexpr const char* log_name = "outputs.raw";

struct Descriptor {
  explicit Descriptor(int opened) : number(opened) {}
  ~Descriptor() { ::close(number); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  int number;
};

// The number of the output, the size of its row, the row. A row replaces that of an earlier output with its number and
// all after it: the last output may be shown again.
std::string row_of(std::uint64_t number, const std::string& output) {
  const std::uint64_t head[] = {number, output.size()};
  return std::string(reinterpret_cast<const char*>(head), sizeof head) + output;
}

std::uint64_t sum_of(std::uint64_t before, std::string_view bytes) {
  return crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size());
}

void write_at(int descriptor, std::uint64_t place, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t written = ::pwrite(descriptor, bytes.data(), bytes.size(), static_cast<off_t>(place));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail();
    place += static_cast<std::uint64_t>(written);
    bytes.remove_prefix(static_cast<std::size_t>(written));
  }
}

}  // namespace

fs::path outputs_log(const fs::path& folder) { return folder / checkpoints_folder / log_name; }

void append_outputs(const fs::path& folder, const std::vector<std::string>& outputs, OutputsMark& mark,
                    const InHaste& in_haste) {
  const fs::path name = outputs_log(folder);
  make_folder(name.parent_path(), in_haste);
  const Descriptor file(::open(name.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666));
  struct stat facts {};
  if (file.number < 0 || ::fstat(file.number, &facts) != 0) fail();
  if (!S_ISREG(facts.st_mode)) throw std::system_error(EEXIST, std::generic_category());
  // Somebody has cut or removed it: all is said again.
  OutputsMark next = static_cast<std::uint64_t>(facts.st_size) < mark.bytes ? OutputsMark() : mark;
  const auto differ = std::mismatch(outputs.begin(), outputs.end(), next.outputs.begin(), next.outputs.end()).first;
  std::string rows;
  for (auto output = differ; output != outputs.end(); ++output)
    rows += row_of(static_cast<std::uint64_t>(output - outputs.begin()), *output);
  if (static_cast<std::uint64_t>(facts.st_size) > next.bytes &&
      ::ftruncate(file.number, static_cast<off_t>(next.bytes)) != 0)
    fail();
  write_at(file.number, next.bytes, rows);
  if (force_to_disk(file.number, in_haste)) flush_folder(name.parent_path());
  next.bytes += rows.size();
  next.crc32 = sum_of(next.crc32, rows);
  if (!rows.empty()) next.outputs = outputs;
  mark = std::move(next);
}

OutputsMark read_outputs(const fs::path& folder, std::uint64_t bytes, std::uint64_t crc32) {
  if (bytes == 0) return {};
  const fs::path name = outputs_log(folder);
  std::error_code problem;
  if (!fs::is_regular_file(fs::symlink_status(name, problem)))
    throw std::runtime_error(fmt::format("{} is missing", log_name));
  if (const auto there = fs::file_size(name, problem); problem || there < bytes)
    throw std::runtime_error(fmt::format("{} has {} bytes, must have {}", log_name, there, bytes));
  std::string text(bytes, '\0');
  if (!std::ifstream(name, std::ios::binary).read(text.data(), static_cast<std::streamsize>(text.size())))
    throw std::runtime_error(fmt::format("{} cannot be read", log_name));
  if (sum_of(0, text) != crc32)
    throw std::runtime_error(fmt::format("{} is damaged: its check sum is wrong", log_name));
  OutputsMark mark{bytes, crc32, {}};
  for (std::string_view left = text; !left.empty();) {
    std::uint64_t head[2];
    const auto refuse = [] { throw std::runtime_error(fmt::format("{} is damaged: its rows are wrong", log_name)); };
    if (left.size() < sizeof head) refuse();
    std::memcpy(head, left.data(), sizeof head);
    left.remove_prefix(sizeof head);
    if (head[0] > mark.outputs.size() || head[1] > left.size()) refuse();
    mark.outputs.resize(head[0]);
    mark.outputs.emplace_back(left.substr(0, head[1]));
    left.remove_prefix(head[1]);
  }
  return mark;
}

}  // namespace gaussdrift::write
