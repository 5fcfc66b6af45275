// The bytes of a data file from any place on. Nothing is reserved for what a file only claims to have.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::read {

/// Throws GridFileError unless the file is there, is a regular file that can be read, and is not too long.
void check_readable(const std::filesystem::path& file);

class FileBytes {
 public:
  /// Throws GridFileError as check_readable() does.
  explicit FileBytes(const std::filesystem::path& file);

  std::uint64_t size() const { return size_; }
  std::string name() const { return name_; }
  /// Reads up to `count` bytes from `offset` on; fewer where the file ends.
  std::size_t read(std::uint64_t offset, char* to, std::size_t count);

 private:
  std::ifstream stream_;
  std::uint64_t size_ = 0;
  std::string name_;
};

/// A part of a file in pieces: as it stands, or decoded from base64, up to the first sign that is none of base64.
class ByteStream {
 public:
  ByteStream(FileBytes& file, std::uint64_t begin, std::uint64_t end, bool base64)
      : file_(&file), at_(begin), end_(end), base64_(base64) {}

  /// Fewer bytes than asked for where there are no more.
  std::size_t read(unsigned char* to, std::size_t count);
  /// The place in the file behind what was read. Base64 that ends within a group of four signs ends with that group.
  std::uint64_t place() const { return at_ - (block_.size() - first_); }
  /// Is nothing left but blanks?
  bool at_end();

 private:
  bool refill();
  bool next_group();
  std::size_t read_whole_groups(unsigned char* to, std::size_t count);

  FileBytes* file_;
  std::uint64_t at_, end_;
  bool base64_;
  std::vector<char> block_{};
  std::size_t first_ = 0;  // sign of the block that comes next
  unsigned char group_[3]{};
  std::size_t of_group_ = 0, in_group_ = 0;  // bytes that were taken, and that are there
  bool ended_ = false;
};

}  // namespace gaussdrift::read
