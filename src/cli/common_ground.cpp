#include "cli/common_ground.hpp"

#include <fmt/format.h>
#include <unistd.h>
#if __has_include(<gnu/libc-version.h>)
#include <gnu/libc-version.h>
#endif

#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <optional>
#include <utility>
#include <vector>

#include "core/dispatch.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

std::string host_name() {
  std::array<char, 256> name{};
  return ::gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unknown host";
}

/// The folder itself, or the nearest one above it that is there already: nothing is made before the run may begin.
fs::path nearest_there(const fs::path& folder) {
  std::error_code ignored;
  fs::path there = fs::absolute(folder).lexically_normal();
  while (!fs::is_directory(there, ignored) && there != there.root_path()) there = there.parent_path();
  return there;
}

/// An empty file of a new name, for as long as it lives: other hosts cannot have heard of it before.
class Mark {
 public:
  explicit Mark(const fs::path& folder) : path_((folder / ".gaussdrift-ranks-XXXXXX").string()) {
    const int file = ::mkstemp(path_.data());
    if (file < 0) throw FileError(fmt::format("{} cannot be written: {}", folder.string(), std::strerror(errno)));
    ::close(file);
  }
  ~Mark() { ::unlink(path_.c_str()); }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;

  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

}  // namespace

void check_that_all_see(base::Communicator& ranks, const fs::path& folder) {
  if (ranks.size() == 1) return;
  const bool first = ranks.rank() == 0;
  std::optional<Mark> mark;
  ranks.agree_on([&] {
    if (first) mark.emplace(nearest_there(folder));
  });
  base::Bytes told = base::to_bytes(first ? mark->path() : "");
  ranks.broadcast(told);
  const fs::path path = base::to_text(told);
  ranks.agree_on([&] {
    if (::access(path.c_str(), F_OK) != 0)
      throw FileError(fmt::format(
          "rank {} on {} does not see what rank 0 writes in {}. The folder has to lie on a file system that "
          "all hosts share.",
          ranks.rank(), host_name(), path.parent_path().string()));
  });
}

std::string arithmetic_here() {
  std::string words = core::fastest_instruction_set().name;
#if __has_include(<gnu/libc-version.h>)
  words += fmt::format(", C library {}", ::gnu_get_libc_version());
#endif
  return words;
}

std::string warning_of_different_arithmetic(base::Communicator& ranks, const std::string& own) {
  const std::vector<base::Bytes> all = ranks.gather(base::to_bytes(own + "\n" + host_name()));
  const auto split = [](const std::string& text) {
    const auto end = text.find('\n');
    return std::pair(text.substr(0, end), text.substr(end + 1));
  };
  for (std::size_t r = 1; r < all.size(); ++r) {
    const auto [words, host] = split(base::to_text(all[r]));
    if (words != own)
      return fmt::format(
          "ranks do not compute alike: rank 0 on {} has {}, rank {} on {} has {}. The last digits depend on which host "
          "computed them.",
          host_name(), own, r, host, words);
  }
  return "";
}

}  // namespace gaussdrift::cli
