#include "base/text_file.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <system_error>

#include "gaussdrift/error.hpp"

namespace gaussdrift::base {

namespace {

namespace fs = std::filesystem;

std::string kind_of(const struct stat& facts) {
  if (S_ISDIR(facts.st_mode)) return "a folder";
  if (S_ISCHR(facts.st_mode) || S_ISBLK(facts.st_mode)) return "a device";
  if (S_ISSOCK(facts.st_mode)) return "a socket";
  return "";
}

std::string size_in_words(std::size_t bytes) {
  char text[32];
  const double mb = static_cast<double>(bytes) / 1e6;
  if (bytes < 10'000)
    std::snprintf(text, sizeof text, "%zu bytes", bytes);
  else if (mb < 0.9995)
    std::snprintf(text, sizeof text, "%.0f kB", 1e3 * mb);
  else
    std::snprintf(text, sizeof text, mb < 10 ? "%.1f MB" : "%.0f MB", mb);
  return text;
}

class Reading {
 public:
  Reading(const fs::path& file, std::string_view kind, std::size_t most) : file_(file), kind_(kind), most_(most) {
    struct stat facts {};
    if (::stat(file.c_str(), &facts) == 0) refuse_if_no_text(facts);
    // A pipe to which nobody writes would be waited for without end.
    number_ = ::open(file.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    if (number_ < 0) fail(errno);
  }
  /// Of standard input, which is waited for as long as somebody may write.
  Reading(std::string_view kind, std::size_t most) : file_("standard input"), kind_(kind), most_(most) {
    number_ = ::fcntl(STDIN_FILENO, F_DUPFD_CLOEXEC, 0);
    if (number_ < 0) fail(errno);
  }
  ~Reading() {
    if (number_ >= 0) ::close(number_);
  }
  Reading(const Reading&) = delete;
  Reading& operator=(const Reading&) = delete;

  std::string text() {
    struct stat facts {};
    if (::fstat(number_, &facts) != 0) fail(errno);
    refuse_if_no_text(facts);  // it may have been replaced since
    const bool pipe = !S_ISREG(facts.st_mode);
    if (pipe) most_ = std::min(most_, most_piped);
    const auto size = static_cast<std::size_t>(std::max<off_t>(0, facts.st_size));
    if (!pipe && size > most_) refuse_size(size);
    std::string text;
    text.reserve(pipe ? 0 : size + 1);
    constexpr std::size_t block = std::size_t{1} << 16;
    while (true) {
      const std::size_t before = text.size();
      text.resize(before + block);
      const ssize_t taken = ::read(number_, text.data() + before, block);
      const int reason = errno;
      text.resize(before + (taken > 0 ? static_cast<std::size_t>(taken) : 0));
      if (taken < 0 && reason == EINTR) continue;
      if (taken < 0 && (reason == EAGAIN || reason == EWOULDBLOCK)) {
        wait();
        continue;
      }
      if (taken < 0) fail(reason);
      if (taken == 0 && pipe && text.empty())
        throw FileError(file_.string() + " is a pipe, and nothing came through it; " + std::string(kind_) +
                        " is expected: write to the pipe before, or name a file");
      if (taken == 0) return text;
      if (text.size() > most_) refuse_size(text.size());
    }
  }

 private:
  [[noreturn]] void fail(int reason) const {
    throw FileError("cannot read " + file_.string() + ": " + std::generic_category().message(reason));
  }

  void refuse_if_no_text(const struct stat& facts) const {
    if (const std::string other = kind_of(facts); !other.empty())
      throw FileError(file_.string() + " is " + other + ", not " + std::string(kind_));
  }

  [[noreturn]] void refuse_size(std::size_t bytes) const {
    throw InputError(file_.string() + " has " + size_in_words(bytes) + " or more; " + std::string(kind_) +
                     " has at most " + size_in_words(most_) +
                     (most_ == most_piped ? " where it comes through a pipe: write it to a file" : ""));
  }

  void wait() const {
    pollfd ready{number_, POLLIN, 0};
    if (::poll(&ready, 1, -1) < 0 && errno != EINTR) fail(errno);
  }

  const fs::path file_;
  const std::string_view kind_;
  std::size_t most_;
  int number_ = -1;
};

}  // namespace

std::string read_text_file(const fs::path& file, std::string_view kind, std::size_t most_bytes) {
  return Reading(file, kind, most_bytes).text();
}

std::string read_standard_input(std::string_view kind, std::size_t most_bytes) {
  return Reading(kind, most_bytes).text();
}

std::string what_else_it_is(const fs::path& file) {
  struct stat facts {};
  return ::stat(file.c_str(), &facts) == 0 ? kind_of(facts) : "";
}

}  // namespace gaussdrift::base
