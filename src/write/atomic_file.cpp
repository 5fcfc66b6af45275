// Temporary file, fsync, rename; and messages about failures of the system.
#include "write/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include "gaussdrift/error.hpp"

namespace gaussdrift::write {
namespace {

namespace fs = std::filesystem;

std::string remedy(int reason) {
  switch (reason) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:
      return "free some space, or choose another folder with --out";
    case EACCES:
    case EPERM:
    case EROFS:
      return "allow writing there, or choose another folder with --out";
    case ENOTDIR:
    case EEXIST:
    case EISDIR:
      return "something else has that name; move it away, or choose another folder with --out";
    default:
      return "choose another folder with --out";
  }
}

[[noreturn]] void fail(const fs::path& file, int reason) {
  const std::string why = std::generic_category().message(reason);
  throw FileError(fmt::format("cannot write {}: {} ({}); {}; everything written before is intact", file.string(), why,
                              reason, remedy(reason)));
}

/// A descriptor that closes itself on the way out of an error.
class Descriptor {
 public:
  Descriptor(const fs::path& file, int flags) : number_(::open(file.c_str(), flags | O_CLOEXEC, 0666)) {
    if (number_ < 0) throw std::system_error(errno, std::generic_category());
  }
  ~Descriptor() {
    if (number_ >= 0) ::close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  void write(std::string_view text) const {
    while (!text.empty()) {
      const ssize_t taken = ::write(number_, text.data(), text.size());
      if (taken < 0 && errno == EINTR) continue;
      if (taken < 0) throw std::system_error(errno, std::generic_category());
      text.remove_prefix(static_cast<std::size_t>(taken));
    }
  }
  /// Returns when the disk has it. File systems without fsync (EINVAL) have nothing to say.
  void flush() const {
    if (::fsync(number_) != 0 && errno != EINVAL) throw std::system_error(errno, std::generic_category());
  }
  /// Some file systems report a full disk only here.
  void close() {
    if (::close(std::exchange(number_, -1)) != 0 && errno != EINTR)
      throw std::system_error(errno, std::generic_category());
  }

 private:
  int number_;
};

}  // namespace

void write_atomically(const fs::path& file, const std::function<void(const fs::path&)>& write) {
  const fs::path part = file.string() + ".part";
  try {
    if (file.has_parent_path()) fs::create_directories(file.parent_path());
    write(part);
    Descriptor written(part, O_RDONLY);
    written.flush();
    written.close();
    fs::rename(part, file);
  } catch (const std::system_error& error) {  // also of the file system library
    std::error_code ignored;
    fs::remove(part, ignored);
    fail(file, error.code().value());
  } catch (...) {
    std::error_code ignored;
    fs::remove(part, ignored);
    throw;
  }
}

void write_text(const fs::path& file, std::string_view text) {
  write_atomically(file, [&](const fs::path& part) {
    Descriptor out(part, O_WRONLY | O_CREAT | O_TRUNC);
    out.write(text);
    out.close();
  });
}

}  // namespace gaussdrift::write
