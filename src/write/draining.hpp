// Text that goes to the disk as it is made, so that it takes little memory.
#pragma once

#include <cerrno>
#include <cstdio>
#include <string>
#include <string_view>
#include <system_error>

namespace gaussdrift::write {

/// Throws std::system_error.
inline void write_bytes(std::FILE* file, std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size())
    throw std::system_error(errno, std::generic_category());
}
inline void flush(std::FILE* file) {
  if (std::fflush(file) != 0) throw std::system_error(errno, std::generic_category());
}

class Draining {
 public:
  explicit Draining(std::FILE* file) : file_(file) {}
  std::string text;

  /// Call it now and then.
  void some() {
    constexpr std::size_t most = 1 << 20;
    if (text.size() > most) all();
  }
  void all() {
    write_bytes(file_, text);
    text.clear();
  }

 private:
  std::FILE* file_;
};

}  // namespace gaussdrift::write
