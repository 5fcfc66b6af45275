// A file that grows by pieces before a constant end, and is whole at every moment. What is written grows with the file,
// not with its square.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "write/part_file.hpp"

namespace gaussdrift::write {

/// Two files take turns: a reader sees the one, the other is hidden. A new piece goes to the end of the hidden one, with
/// the piece before, which it lacks. Then it takes the name. So a piece is written twice, and a reader never sees a file
/// that is being written. One write at the end of a file that is seen would not do: Linux shows it page by page, and a
/// process that is killed may stop between two of them.
class GrowingFile {
 public:
  /// The file ends with `end`.
  explicit GrowingFile(std::filesystem::path file, std::string end = {})
      : file_(std::move(file)), end_(std::move(end)) {}

  /// Replaces whatever has the name by `body` and the end. Throws FileError; the file is as before then.
  void begin(std::string_view body);
  /// Goes on with the file of that name behind its first `size` bytes; what follows them is dropped. Throws FileError:
  /// also where there are fewer. The file is as before then.
  void take_up(long size);
  /// Puts `piece` behind the body. Throws FileError; the file is as before then, and may be appended to again.
  void append(std::string_view piece);

 private:
  struct Twin {
    std::unique_ptr<PartFile> file;
    long size = 0;  // of its body
  };

  std::filesystem::path file_;
  std::string end_;
  std::string last_;  // piece, which the hidden one lacks
  Twin seen_, hidden_;
};

}  // namespace gaussdrift::write
