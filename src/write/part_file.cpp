#include "write/part_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/seam.hpp"
#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/system_failure.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view name_begin = ".gaussdrift-", name_end = ".part";

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// A name that nobody in this folder had before.
fs::path next_name(const fs::path& folder) {
  static std::atomic<unsigned long> count{0};
  return folder / fmt::format("{}{}-{}{}", name_begin, getpid(), count++, name_end);
}

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
    case ELOOP:
      return "something else has that name; move it away, or choose another folder with --out";
    default:
      return "choose another folder with --out";
  }
}

bool same_file(int descriptor, const fs::path& name) {
  struct stat open {
  }, named{};
  return ::fstat(descriptor, &open) == 0 && ::lstat(name.c_str(), &named) == 0 && open.st_dev == named.st_dev &&
         open.st_ino == named.st_ino;
}

bool is_in(const InHaste& haste) { return haste && haste(); }

/// Starts to write a part of a file, or waits for it. What is not known here is left to fsync.
void force_part(int descriptor, off_t first, off_t size, bool wait) {
#ifdef SYNC_FILE_RANGE_WRITE  // of Linux
  const unsigned how =
      wait ? SYNC_FILE_RANGE_WAIT_BEFORE | SYNC_FILE_RANGE_WRITE | SYNC_FILE_RANGE_WAIT_AFTER : SYNC_FILE_RANGE_WRITE;
  if (::sync_file_range(descriptor, first, size, how) != 0 && errno != EINVAL && errno != ENOSYS && errno != ESPIPE)
    fail();
#endif
}

}  // namespace

bool force_to_disk(int descriptor, const InHaste& in_haste) {
  constexpr off_t part = 8 << 20;  // a twentieth of a second on a slow disk
  struct stat facts {};
  if (::fstat(descriptor, &facts) != 0) fail();
  for (off_t first = 0; first + part < facts.st_size; first += part) {
    if (is_in(in_haste)) return false;
    base::seam();
    force_part(descriptor, first + part, part, false);  // the disk is not to wait for us
    force_part(descriptor, first, part, true);
  }
  if (is_in(in_haste)) return false;
  // File systems without fsync (EINVAL) have nothing to say.
  if (::fsync(descriptor) != 0 && errno != EINVAL) fail();
  return true;
}

void fail_to_write(const fs::path& file, int reason) {
  throw FileError(fmt::format("cannot write {}: {} ({}); {}; everything written before is intact", file.string(),
                              std::generic_category().message(reason), reason, remedy(reason)));
}

void flush_folder(const fs::path& folder) {
  const int descriptor = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (descriptor < 0 && errno == EACCES) return;  // may be written, not read: nothing can be asked
  if (descriptor < 0) fail();
  // File systems without fsync of folders (EINVAL) have nothing to say.
  const int problem = ::fsync(descriptor) == 0 || errno == EINVAL ? 0 : errno;
  ::close(descriptor);
  if (problem) throw std::system_error(problem, std::generic_category());
}

void make_folder(const fs::path& folder, const InHaste& in_haste) {
  std::vector<fs::path> made;
  for (fs::path name = folder; !name.empty() && !fs::exists(name); name = name.parent_path()) made.push_back(name);
  fs::create_directories(folder);
  for (const fs::path& name : made)
    if (!is_in(in_haste)) flush_folder(folder_of(name));
}

bool is_part_name(std::string_view name) {
  if (!name.starts_with(name_begin) || !name.ends_with(name_end)) return false;
  name.remove_prefix(name_begin.size());
  name.remove_suffix(name_end.size());
  return !name.empty() && name.find_first_not_of("0123456789-") == std::string_view::npos;
}

void remove_what_killed_processes_left(const fs::path& folder) {
  std::error_code ignored;
  for (auto entry = fs::directory_iterator(folder, ignored); !ignored && entry != fs::directory_iterator();
       entry.increment(ignored)) {
    if (!is_part_name(entry->path().filename().string())) continue;
    const int descriptor = ::open(entry->path().c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC);
    if (descriptor < 0) continue;
    // Its process holds the lock from the beginning to its end.
    if (::flock(descriptor, LOCK_EX | LOCK_NB) == 0) ::unlink(entry->path().c_str());
    ::close(descriptor);
  }
}

PartFile::PartFile(const fs::path& file) {
  const fs::path folder = folder_of(file);
  for (;;) {
    fs::path name = next_name(folder);
    const int descriptor = ::open(name.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
    if (descriptor < 0 && errno == EEXIST) continue;  // of a killed process with the same number
    if (descriptor < 0) fail();
    // Where files cannot be locked, nobody else can lock it, and it is not taken for a dead one.
    const bool locked = ::flock(descriptor, LOCK_EX | LOCK_NB) == 0;
    if ((!locked && errno == EWOULDBLOCK) || !same_file(descriptor, name)) {  // taken for dead before it was locked
      ::close(descriptor);
      continue;
    }
    stream_ = ::fdopen(descriptor, "w+b");
    if (!stream_) {
      const int problem = errno;
      ::unlink(name.c_str());
      ::close(descriptor);
      throw std::system_error(problem, std::generic_category());
    }
    hidden_ = std::move(name);
    return;
  }
}

PartFile::~PartFile() {
  if (!hidden_.empty()) ::unlink(hidden_.c_str());
  if (stream_) std::fclose(stream_);
}

void PartFile::write_at(long position, std::string_view text) {
  if (std::fseek(stream_, position, SEEK_SET) != 0) fail();
  if (std::fwrite(text.data(), 1, text.size(), stream_) != text.size()) fail();
}

void PartFile::flush(const InHaste& in_haste) {
  if (std::fflush(stream_) != 0) fail();
  force_to_disk(::fileno(stream_), in_haste);
}

void PartFile::take_name(const fs::path& file, const InHaste& in_haste) {
  if (::rename(hidden_.c_str(), file.c_str()) != 0) fail();
  hidden_.clear();
  if (!is_in(in_haste)) flush_folder(folder_of(file));
}

bool PartFile::hide_again(const fs::path& file) {
  if (!hidden_.empty()) ::unlink(hidden_.c_str());  // it has one already: another file could not take the name
  hidden_.clear();
  const fs::path name = next_name(folder_of(file));
  if (::link(file.c_str(), name.c_str()) != 0) return false;
  if (!same_file(::fileno(stream_), name)) {
    ::unlink(name.c_str());
    return false;
  }
  hidden_ = name;
  return true;
}

}  // namespace gaussdrift::write
