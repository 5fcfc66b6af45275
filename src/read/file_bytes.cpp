#include "read/file_bytes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "base/text_file.hpp"
#include "read/grid_file.hpp"
#include "read/grid_file_error.hpp"
#include "read/stored_grid.hpp"

namespace gaussdrift::read {

namespace {

// Before a file is opened: the numbers that are read as text, three times as long, a line for each of a million times,
// and one for each of 131072 pieces.
constexpr double largest_data_file = 3 * 8 * most_numbers, largest_series_file = 2e8, largest_index_file = 4e7;
constexpr std::size_t block_bytes = 65536;

constexpr unsigned char no_digit = 64, blank = 65;
constexpr std::array<unsigned char, 256> digits_of_base64() {
  std::array<unsigned char, 256> digits{};
  for (auto& digit : digits) digit = no_digit;
  unsigned char value = 0;
  for (char c = 'A'; c <= 'Z'; ++c) digits[static_cast<unsigned char>(c)] = value++;
  for (char c = 'a'; c <= 'z'; ++c) digits[static_cast<unsigned char>(c)] = value++;
  for (char c = '0'; c <= '9'; ++c) digits[static_cast<unsigned char>(c)] = value++;
  digits['+'] = value++;
  digits['/'] = value;
  for (const unsigned char c : {' ', '\t', '\r', '\n'}) digits[c] = blank;
  return digits;
}
constexpr std::array<unsigned char, 256> digit_of = digits_of_base64();

}  // namespace

void check_readable(const std::filesystem::path& file) {
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw GridFileError(fmt::format("there is no file {}", file.string()),
                        "paths are relative to the folder of the case file");
  if (const std::string other = base::what_else_it_is(file); !other.empty())
    throw GridFileError(fmt::format("{} is {}, not a file of data", file.string(), other));
  if (!std::filesystem::is_regular_file(file, error))
    throw GridFileError(fmt::format("{} is a pipe", file.string()),
                        "data on a grid are read several times: write them to a file");
  if (!std::ifstream(file, std::ios::binary))
    throw GridFileError(fmt::format("the file {} cannot be read", file.string()));
  const std::uintmax_t bytes = std::filesystem::file_size(file, error);
  if (is_netcdf(file)) return;  // is read in parts
  const double most = file.extension() == ".pvd"    ? largest_series_file
                      : file.extension() == ".pvti" ? largest_index_file
                                                    : largest_data_file;
  if (!error && static_cast<double>(bytes) > most)
    throw GridFileError(fmt::format("{} has {:.3g} MB; at most {:.3g} MB are read", file.string(),
                                    static_cast<double>(bytes) / 1e6, most / 1e6),
                        "leave times or points out");
}

FileBytes::FileBytes(const std::filesystem::path& file) : name_(file.filename().string()) {
  check_readable(file);
  stream_.open(file, std::ios::binary);
  stream_.seekg(0, std::ios::end);
  if (const auto size = stream_.tellg(); stream_ && size > 0) size_ = static_cast<std::uint64_t>(size);
}

std::size_t FileBytes::read(std::uint64_t offset, char* to, std::size_t count) {
  if (offset >= size_) return 0;
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(offset));
  stream_.read(to, static_cast<std::streamsize>(std::min<std::uint64_t>(count, size_ - offset)));
  return static_cast<std::size_t>(std::max<std::streamsize>(0, stream_.gcount()));
}

bool ByteStream::refill() {
  if (at_ >= end_) return false;
  block_.resize(static_cast<std::size_t>(std::min<std::uint64_t>(block_bytes, end_ - at_)));
  const std::size_t got = file_->read(at_, block_.data(), block_.size());
  block_.resize(got);
  at_ += got;
  first_ = 0;
  return got > 0;
}

bool ByteStream::next_group() {
  std::size_t count = 0;
  std::uint32_t bits = 0;
  bool padded = false;
  for (std::size_t signs = 0; signs < 4 && !ended_;) {
    if (first_ >= block_.size() && !refill()) {
      ended_ = true;
      break;
    }
    const auto sign = static_cast<unsigned char>(block_[first_]);
    const unsigned char digit = digit_of[sign];
    if (digit == blank) {
      ++first_;
      continue;
    }
    if (digit == no_digit && sign != '=') {  // belongs to what follows
      ended_ = true;
      break;
    }
    ++first_, ++signs;
    padded = padded || sign == '=';
    bits = bits << 6 | (padded ? 0u : digit);
    if (!padded) ++count;
    if (signs == 4 && padded) ended_ = true;
  }
  in_group_ = count < 2 ? 0 : count - 1;
  for (std::size_t k = count; !padded && k < 4; ++k) bits <<= 6;
  for (std::size_t k = 0; k < 3; ++k) group_[k] = static_cast<unsigned char>(bits >> (16 - 8 * k));
  of_group_ = 0;
  return in_group_ > 0;
}

// Almost all of a large file: four digits side by side. next_group() does the others.
std::size_t ByteStream::read_whole_groups(unsigned char* to, std::size_t count) {
  std::size_t done = 0;
  for (; count - done >= 3 && block_.size() - first_ >= 4; first_ += 4, done += 3) {
    std::array<std::uint32_t, 4> digits{};
    for (std::size_t k = 0; k < 4; ++k) digits[k] = digit_of[static_cast<unsigned char>(block_[first_ + k])];
    if ((digits[0] | digits[1] | digits[2] | digits[3]) >= no_digit) break;
    const std::uint32_t bits = digits[0] << 18 | digits[1] << 12 | digits[2] << 6 | digits[3];
    for (std::size_t k = 0; k < 3; ++k) to[done + k] = static_cast<unsigned char>(bits >> (16 - 8 * k));
  }
  return done;
}

std::size_t ByteStream::read(unsigned char* to, std::size_t count) {
  std::size_t done = 0;
  while (done < count) {
    if (base64_) {
      if (of_group_ == in_group_ && !ended_) done += read_whole_groups(to + done, count - done);
      if (done == count) break;
      if (of_group_ == in_group_ && (ended_ || !next_group())) break;
      to[done++] = group_[of_group_++];
    } else {
      if (first_ >= block_.size() && !refill()) break;
      const std::size_t some = std::min(count - done, block_.size() - first_);
      std::copy_n(block_.begin() + static_cast<std::ptrdiff_t>(first_), some, to + done);
      first_ += some, done += some;
    }
  }
  return done;
}

bool ByteStream::at_end() {
  if (of_group_ < in_group_) return false;
  while (first_ < block_.size() || refill())
    if (digit_of[static_cast<unsigned char>(block_[first_++])] != blank) return false;
  return true;
}

}  // namespace gaussdrift::read
