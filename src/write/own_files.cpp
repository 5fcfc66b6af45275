#include "write/own_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
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

/// "a/b_{0000..0012}/{0000..0007}.vti" leads into "a/b_0012".
bool leads_into(std::string_view name, std::string_view folder) {
  const std::size_t slash = name.rfind('/');
  return slash != name.npos && matches(name.substr(0, slash), folder);
}

bool is_folder(const fs::directory_entry& entry) { return entry.is_directory() && !entry.is_symlink(); }

/// The disk is to have what happened to names in the folder, and in those of `inner` that are there.
void flush(const fs::path& folder, const std::set<fs::path>& inner) {
  flush_folder(folder);
  for (const fs::path& name : inner)
    if (fs::exists(folder / name)) flush_folder(folder / name);
}

/// After files are gone: those of `inner` that are empty go, too.
void remove_empty(const fs::path& folder, const std::set<fs::path>& inner) {
  for (auto name = inner.rbegin(); name != inner.rend(); ++name)  // from the inside out
    if (fs::is_empty(folder / *name)) fs::remove(folder / *name);
  flush(folder, inner);
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

std::vector<std::string> names_in_state(std::size_t outputs) {
  std::vector<std::string> names{"state/outputs.raw"};
  for (const std::string folder : {"state/0/", "state/1/"}) {
    for (const char* file : {"manifest.json", "run.raw"}) names.push_back(folder + file);
    names.push_back(numbered_names(folder + "particles_", most_pieces, ".raw"));
  }
  for (const char* what : {"density_", "error_"})
    names.push_back(numbered_names(std::string("state/pictures/") + what, outputs, ".raw"));
  return names;
}

std::string numbered_names(std::string_view before, std::size_t count, std::string_view ending) {
  return fmt::format("{}{{0000..{:04}}}{}", before, count == 0 ? 0 : count - 1, ending);
}

OwnFiles::OwnFiles(const std::vector<std::string>& names) {
  for (const std::string& name : names) add(name);
}

void OwnFiles::add(const std::string& name) {
  if (!stays_inside(name)) return;
  const bool many = name.find('{') != name.npos;
  if (name.ends_with('/')) {  // as earlier versions named pieces, and what is in state/
    if (many)
      for (const char* ending : {".vti", ".vtp"}) add(numbered_names(name, most_pieces, ending));
    else
      for (const std::string& file : names_in_state(most_outputs))
        if (file.starts_with(name)) add(file);
    return;
  }
  if (many ? std::find(many_.begin(), many_.end(), name) != many_.end() : !single_.insert(name).second) return;
  if (many) many_.push_back(name);
  names_.push_back(name);
}

bool OwnFiles::has(std::string_view file) const {
  return single_.contains(std::string(file)) || std::any_of(many_.begin(), many_.end(), [&](const std::string& name) {
           return name == file || matches(name, file);
         });
}

OwnFiles::Found OwnFiles::look(const fs::path& folder) const {
  Found found;
  on_files(folder, "looked at", [&] {
    for (const auto& entry : fs::directory_iterator(folder)) {
      const std::string name = entry.path().filename().string();
      if (!is_folder(entry)) {
        if (has(name)) found.files.push_back(name);
        continue;
      }
      const std::string into = name + "/";
      if (std::any_of(names_.begin(), names_.end(), [&](const std::string& own) { return own.starts_with(into); }))
        found.folders.insert(name);
      for (const auto& inner : fs::directory_iterator(entry.path())) {
        const std::string file = name + "/" + inner.path().filename().string();
        // What may hold pieces; a link in its place is the run's own, too.
        const bool of_pieces =
            std::any_of(many_.begin(), many_.end(), [&](const std::string& many) { return leads_into(many, file); });
        if (!is_folder(inner)) {
          if (has(file) || (of_pieces && inner.is_symlink())) found.files.push_back(file);
          continue;
        }
        if (!of_pieces) continue;
        found.folders.insert(file);
        for (const auto& piece : fs::directory_iterator(inner.path()))
          if (const std::string in_it = file + "/" + piece.path().filename().string(); has(in_it) && !is_folder(piece))
            found.files.push_back(in_it);
      }
    }
  });
  std::sort(found.files.begin(), found.files.end());
  return found;
}

double OwnFiles::bytes_in(const fs::path& folder) const {
  double bytes = 0;
  std::error_code ignored;
  for (const std::string& file : look(folder).files)
    if (const auto size = fs::file_size(folder / file, ignored); !ignored) bytes += static_cast<double>(size);
  return bytes;
}

void OwnFiles::remove_from(const fs::path& folder) const {
  on_files(folder, "removed", [&] {
    const Found found = look(folder);
    for (const std::string& file : found.files) fs::remove(folder / file);
    remove_empty(folder, found.folders);
  });
}

void OwnFiles::move(const fs::path& folder, const fs::path& to) const {
  on_files(folder, "moved aside", [&] {
    const Found found = look(folder);
    std::set<fs::path> reached;
    for (const std::string& file : found.files) {
      if (const fs::path parent = fs::path(file).parent_path(); !parent.empty() && reached.insert(parent).second)
        make_folder(to / parent);
      fs::rename(folder / file, to / file);
    }
    flush(to, reached);
    remove_empty(folder, found.folders);
  });
}

}  // namespace gaussdrift::write
