// The hidden file that is written before it takes its name. It is locked while its process lives, so that others can tell
// what a killed process has left.
#pragma once

#include <cstdio>
#include <filesystem>
#include <string_view>

namespace gaussdrift::write {

/// Throws FileError: `file` cannot be written, for the reason errno `reason`.
[[noreturn]] void fail_to_write(const std::filesystem::path& file, int reason);

/// Returns when the disk has the names in the folder. Throws std::system_error.
void flush_folder(const std::filesystem::path& folder);

/// A file that goes away with this object, unless it has got a name. All throw std::system_error.
class PartFile {
 public:
  /// In the folder of `file`.
  explicit PartFile(const std::filesystem::path& file);
  ~PartFile();
  PartFile(const PartFile&) = delete;
  PartFile& operator=(const PartFile&) = delete;

  std::FILE* stream() const { return stream_; }
  void write_at(long position, std::string_view text);
  /// Returns when the disk has all of it. What a disk cannot take is known then, and not only when the file is closed.
  void flush();
  /// Replaces `file` by this one. It stays open, so that what it holds can be read and lengthened.
  void take_name(const std::filesystem::path& file);
  /// A second, hidden name for a file that has taken the name `file`; it may lose the other one then. False where that
  /// name is another file's by now, or where files have one name only.
  bool hide_again(const std::filesystem::path& file);

 private:
  std::filesystem::path hidden_;  // empty: it has a name
  std::FILE* stream_ = nullptr;
};

}  // namespace gaussdrift::write
