#include "write/own_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <system_error>

#include "gaussdrift/error.hpp"
#include "write/part_file.hpp"

namespace gaussdrift::write {

namespace fs = std::filesystem;

namespace {

std::optional<std::size_t> number_in(std::string_view digits) {
  std::size_t number = 0;
  const auto [end, problem] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (problem != std::errc{} || end != digits.data() + digits.size()) return std::nullopt;
  return number;
}

/// "before{0000..0012}ending" has "before0007ending"; a name without a range has itself.
bool in_range(std::string_view range, std::string_view file) {
  const std::size_t open = range.find('{'), dots = range.find("..", open), close = range.find('}', open);
  if (open == range.npos) return range == file;
  if (dots == range.npos || close == range.npos || dots > close) return false;
  const std::string_view before = range.substr(0, open), ending = range.substr(close + 1);
  if (file.size() <= before.size() + ending.size() || !file.starts_with(before) || !file.ends_with(ending))
    return false;
  const std::string_view digits = file.substr(before.size(), file.size() - before.size() - ending.size());
  const auto first = number_in(range.substr(open + 1, dots - open - 1)),
             last = number_in(range.substr(dots + 2, close - dots - 2)), number = number_in(digits);
  return first && last && number && *first <= *number && *number <= *last && fmt::format("{:04}", *number) == digits;
}

/// A list may come from a stranger's folder.
bool stays_inside(const std::string& name) {
  if (name.empty() || name.front() == '/' || name.find('\0') != name.npos) return false;
  const fs::path path(name);
  return std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".." || part == "."; }) &&
         std::count(name.begin(), name.end(), '/') <= 2;
}

/// The part of a name before its first slash, which is cut off with it.
std::string_view first_part(std::string_view& name) {
  const std::string_view part = name.substr(0, name.find('/'));
  name.remove_prefix(std::min(name.size(), part.size() + 1));
  return part;
}

/// Each part of the name is in the range that stands at its place.
bool matches(std::string_view ranges, std::string_view file) {
  if (ranges.ends_with('/')) return false;
  while (!ranges.empty() && !file.empty())
    if (!in_range(first_part(ranges), first_part(file))) return false;
  return ranges.empty() && file.empty();
}

/// "folder/" has all that is in there.
bool in_folder(std::string_view folder, std::string_view file) {
  return folder.ends_with('/') && file.starts_with(folder);
}

/// "a/b_{0000..0012}/{0000..0007}.vti" and "a/b_0012/" lead into "a/b_0012".
bool leads_into(std::string_view name, std::string_view folder) {
  const std::size_t slash = name.rfind('/');
  return slash != name.npos && matches(name.substr(0, slash), folder);
}

/// Folders on the way to a file that is gone, from the inside out.
void remove_empty(const fs::path& folder, fs::path parent) {
  for (; !parent.empty() && fs::is_empty(folder / parent); parent = parent.parent_path()) fs::remove(folder / parent);
}

template <class Action>
void on_files(const fs::path& folder, const char* what, const Action& action) {
  try {
    action();
  } catch (const fs::filesystem_error& failure) {
    throw FileError(fmt::format("the earlier run in {} cannot be {}: {}: {}; choose another folder with --out",
                                folder.string(), what, failure.path1().string(), failure.code().message()));
  } catch (const std::system_error& failure) {
    throw FileError(fmt::format("the earlier run in {} cannot be {}: {}; choose another folder with --out",
                                folder.string(), what, failure.code().message()));
  }
}

}  // namespace

std::string numbered_names(std::string_view before, std::size_t count, std::string_view ending) {
  return fmt::format("{}{{0000..{:04}}}{}", before, count == 0 ? 0 : count - 1, ending);
}

OwnFiles::OwnFiles(const std::vector<std::string>& names) {
  for (const std::string& name : names) add(name);
}

void OwnFiles::add(const std::string& name) {
  if (!stays_inside(name)) return;
  if (name.ends_with('/') && name.find('{') != name.npos) {  // as earlier versions named pieces
    for (const char* ending : {".vti", ".vtp"}) add(numbered_names(name, most_pieces, ending));
    return;
  }
  const bool many = name.ends_with('/') || name.find('{') != name.npos;
  if (many ? std::find(many_.begin(), many_.end(), name) != many_.end() : !single_.insert(name).second) return;
  if (many) many_.push_back(name);
  names_.push_back(name);
}

bool OwnFiles::has(std::string_view file) const {
  return single_.contains(std::string(file)) || std::any_of(many_.begin(), many_.end(), [&](const std::string& name) {
           return name == file || in_folder(name, file) || matches(name, file);
         });
}

std::vector<std::string> OwnFiles::found_in(const fs::path& folder) const {
  std::vector<std::string> found;
  on_files(folder, "looked at", [&] {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (entry.is_symlink() || !entry.is_directory()) {
        if (has(name)) found.push_back(name);
        continue;
      }
      for (const auto& inner : fs::directory_iterator(entry.path())) {
        const std::string file = name + "/" + inner.path().filename().string();
        // What may hold pieces; a link in its place is the run's own, too.
        const bool of_pieces = !has(file) && std::any_of(many_.begin(), many_.end(), [&](const std::string& many) {
          return leads_into(many, file);
        });
        if (has(file) || (of_pieces && inner.is_symlink())) found.push_back(file);
        if (!of_pieces || inner.is_symlink() || !inner.is_directory()) continue;
        for (const auto& piece : fs::directory_iterator(inner.path()))
          if (const std::string in_it = file + "/" + piece.path().filename().string(); has(in_it))
            found.push_back(in_it);
      }
    }
  });
  std::sort(found.begin(), found.end());
  return found;
}

double OwnFiles::bytes_in(const fs::path& folder) const {
  double bytes = 0;
  std::error_code ignored;
  for (const std::string& file : found_in(folder))
    if (const auto size = fs::file_size(folder / file, ignored); !ignored) bytes += static_cast<double>(size);
  return bytes;
}

void OwnFiles::remove_from(const fs::path& folder) const {
  on_files(folder, "removed", [&] {
    for (const std::string& file : found_in(folder)) {
      fs::remove_all(folder / file);  // a folder among them only below one that is the run's own
      remove_empty(folder, fs::path(file).parent_path());
    }
  });
}

void OwnFiles::move(const fs::path& folder, const fs::path& to) const {
  on_files(folder, "moved aside", [&] {
    for (const std::string& file : found_in(folder)) {
      const fs::path parent = fs::path(file).parent_path();
      make_folder(to / parent);
      fs::rename(folder / file, to / file);
      remove_empty(folder, parent);
    }
  });
}

}  // namespace gaussdrift::write
