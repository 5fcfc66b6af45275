// The hidden file that is written before it takes its name. It is locked while its process lives, so that others can tell
// what a killed process has left.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string_view>

namespace gaussdrift::write {

/// Throws FileError: `file` cannot be written, for the reason errno `reason`.
[[noreturn]] void fail_to_write(const std::filesystem::path& file, int reason);

/// Returns when the disk has the names in the folder. Throws std::system_error.
void flush_folder(const std::filesystem::path& folder);

/// Says that there is no time to wait for the disk any longer. Several threads may ask.
using InHaste = std::function<bool()>;

/// Makes a folder, and those around it, where they are not there. Returns when the disk has their names, or at once where
/// `in_haste` says so. Throws std::system_error.
void make_folder(const std::filesystem::path& folder, const InHaste& in_haste = {});

/// Waits until the disk has all of an open file. Large files are waited for piece by piece: each is a seam (base/seam.hpp),
/// and is left where `in_haste` says so. Returns whether the disk has all. Throws std::system_error.
bool force_to_disk(int descriptor, const InHaste& in_haste = {});

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
  /// Returns when the disk has all of it, or the system where `in_haste` says so. What a disk cannot take is known then,
  /// and not only when the file is closed.
  void flush(const InHaste& in_haste = {});
  /// Replaces `file` by this one. It stays open, so that what it holds can be read and lengthened.
  void take_name(const std::filesystem::path& file, const InHaste& in_haste = {});
  /// A second, hidden name for a file that has taken the name `file`; it may lose the other one then. False where that
  /// name is another file's by now, or where files have one name only.
  bool hide_again(const std::filesystem::path& file);

 private:
  std::filesystem::path hidden_;  // empty: it has a name
  std::FILE* stream_ = nullptr;
};

}  // namespace gaussdrift::write
