#include "write/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <string>
#include <system_error>
#include <utility>

#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/part_file.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

[[noreturn]] void refuse(const fs::path& folder, int reason) {
  throw FileError(fmt::format("cannot use {} as output folder: {}; choose another folder with --out", folder.string(),
                              std::generic_category().message(reason)));
}

/// What its holder wrote, to be shown: "process 12 on host".
std::string holder(int descriptor) {
  std::array<char, 120> text{};
  const ssize_t length = ::pread(descriptor, text.data(), text.size(), 0);
  std::string words;
  for (ssize_t i = 0; i < length && text[static_cast<std::size_t>(i)] != '\n'; ++i)
    if (const char c = text[static_cast<std::size_t>(i)]; c >= ' ' && c < 127) words += c;
  return words.empty() ? "another process" : words;
}

constexpr int deepest = 2;  // state/0 in the folder of a run

/// Of what killed processes left in the folder, and so many levels below. Links are not followed.
void clear(const fs::path& folder, int levels) {
  remove_what_killed_processes_left(folder);
  std::error_code problem;
  for (auto entry = fs::directory_iterator(folder, problem);
       levels > 0 && !problem && entry != fs::directory_iterator(); entry.increment(problem))
    if (!entry->is_symlink(problem) && entry->is_directory(problem)) clear(entry->path(), levels - 1);
}

}  // namespace

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "";
}

bool is_in_use(const fs::path& folder) {
  const int descriptor =
      ::open((folder / lock_name).c_str(), O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
  if (descriptor < 0) return false;  // it is removed with the lock
  const bool held = ::flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  return held;
}

FolderLock::FolderLock(fs::path folder) {
  try {
    make_folder(folder);
  } catch (const std::system_error& error) {
    refuse(folder, error.code().value());
  }
  file_ = folder / lock_name;
  for (;;) {
    descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_NONBLOCK | O_CLOEXEC, 0666);
    if (descriptor_ < 0) refuse(folder, errno);
    if (::flock(descriptor_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      const std::string who = holder(descriptor_);
      ::close(descriptor_);
      throw FileError(
          fmt::format("{} is in use: {} writes into it; wait until it ends, or choose another folder with "
                      "--out",
                      folder.string(), who));
    }
    // The holder before has removed it between the two calls: then somebody else may hold the next one.
    struct stat open {
    }, named{};
    if (::fstat(descriptor_, &open) == 0 && ::lstat(file_.c_str(), &named) == 0 && open.st_ino == named.st_ino &&
        open.st_dev == named.st_dev)
      break;
    ::close(descriptor_);
  }
  const std::string words = fmt::format("process {} on {}\n", getpid(), host_name());
  if (::ftruncate(descriptor_, 0) != 0 ||  // what it says is for people: a full disk is met by others
      ::pwrite(descriptor_, words.data(), words.size(), 0) < 0)
    errno = 0;
  clear(folder, deepest);
}

FolderLock::~FolderLock() {
  ::unlink(file_.c_str());  // before it is released, see above
  ::close(descriptor_);
}

}  // namespace gaussdrift::write
