#include "write/growing_file.hpp"

#include <algorithm>
#include <cerrno>
#include <system_error>
#include <vector>

#include "write/system_failure.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

// Of a file that may be large.
void copy_beginning(std::FILE* from, long size, PartFile& to) {
  constexpr long most = 1 << 20;
  std::string text;
  if (std::fseek(from, 0, SEEK_SET) != 0) fail();
  for (long at = 0; at < size; at += most) {
    text.resize(static_cast<std::size_t>(std::min(most, size - at)));
    errno = 0;
    if (std::fread(text.data(), 1, text.size(), from) != text.size()) fail();
    to.write_at(at, text);
  }
}

}  // namespace

void GrowingFile::begin(std::string_view body) {
  try {
    if (file_.has_parent_path()) make_folder(file_.parent_path());
    Twin next{std::make_unique<PartFile>(file_), static_cast<long>(body.size())};
    next.file->write_at(0, std::string(body) + end_);
    next.file->flush();
    next.file->take_name(file_);
    seen_ = std::move(next);
    hidden_ = {};
  } catch (const std::system_error& error) {
    fail_to_write(file_, error.code().value());
  }
}

void GrowingFile::take_up(long size) {
  try {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> old(std::fopen(file_.c_str(), "rb"), std::fclose);
    if (!old) fail();
    Twin next{std::make_unique<PartFile>(file_), size};
    copy_beginning(old.get(), size, *next.file);
    next.file->write_at(size, end_);
    next.file->flush();
    next.file->take_name(file_);
    seen_ = std::move(next);
    hidden_ = {};
    last_.clear();
  } catch (const std::system_error& error) {
    fail_to_write(file_, error.code().value());
  }
}

void GrowingFile::append(std::string_view piece) {
  if (!seen_.file) return begin(piece);
  try {
    Twin next = std::move(hidden_);  // gone if something fails
    hidden_ = {};
    std::string lacking = last_;
    if (!next.file) {
      next = {std::make_unique<PartFile>(file_), seen_.size};
      copy_beginning(seen_.file->stream(), seen_.size, *next.file);
      lacking.clear();
    }
    lacking += piece;
    next.file->write_at(next.size, lacking + end_);
    next.size += static_cast<long>(lacking.size());
    next.file->flush();
    // Where it can have no second name, the next piece begins with a copy.
    const bool turns = seen_.file->hide_again(file_);
    next.file->take_name(file_);
    if (turns) hidden_ = std::move(seen_);
    seen_ = std::move(next);
    last_ = piece;
  } catch (const std::system_error& error) {
    fail_to_write(file_, error.code().value());
  }
}

}  // namespace gaussdrift::write
