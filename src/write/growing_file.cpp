#include "write/growing_file.hpp"

#include <cerrno>
#include <system_error>
#include <vector>

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

std::string beginning_of(const PartFile& file, long size) {
  std::string text(static_cast<std::size_t>(size), '\0');
  if (std::fseek(file.stream(), 0, SEEK_SET) != 0 ||
      std::fread(text.data(), 1, text.size(), file.stream()) != text.size())
    throw std::system_error(errno ? errno : EIO, std::generic_category());
  return text;
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

void GrowingFile::append(std::string_view piece) {
  if (!seen_.file) return begin(piece);
  try {
    Twin next = std::move(hidden_);  // gone if something fails
    hidden_ = {};
    std::string lacking = last_;
    if (!next.file) {
      next = {std::make_unique<PartFile>(file_), 0};
      lacking = beginning_of(*seen_.file, seen_.size);
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
