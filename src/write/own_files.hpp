// The list of files that a run may replace and remove: its own.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <unordered_set>
#include <vector>

namespace gaussdrift::write {

/// Names as seen from the folder of the run, in one of two forms: "series.csv"; "density/density_{0000..0012}.vti", a
/// range as shells write it, or "density/density_{0000..0012}/{0000..0007}.vti", one in each folder of a range. A folder
/// is never a file of the run. Names that lead out of the folder are not taken. Earlier versions named whole folders,
/// "state/0/": they stand for the files that a run writes there.
class OwnFiles {
 public:
  OwnFiles() = default;
  explicit OwnFiles(const std::vector<std::string>& names);
  void add(const std::string& name);
  bool has(std::string_view file) const;
  const std::vector<std::string>& names() const { return names_; }

  /// Those that are there: files, and links of such names, not what they lead to. A folder in `folder` that is a link
  /// is not looked into.
  std::vector<std::string> found_in(const std::filesystem::path& folder) const { return look(folder).files; }
  double bytes_in(const std::filesystem::path& folder) const;
  /// Removes them, and folders that are empty then. Returns when the disk has it so. Throws FileError.
  void remove_from(const std::filesystem::path& folder) const;
  /// Renames them into the folder `to`. Returns when the disk has it so. Throws FileError. What has been moved by an
  /// earlier call stays there.
  void move(const std::filesystem::path& folder, const std::filesystem::path& to) const;

 private:
  struct Found {
    std::vector<std::string> files;
    std::set<std::filesystem::path> folders;  // that the list leads into
  };
  Found look(const std::filesystem::path& folder) const;

  std::vector<std::string> names_;          // in their order
  std::unordered_set<std::string> single_;  // of them, those of one file: a stranger's list may be long
  std::vector<std::string> many_;           // ranges
};

constexpr std::size_t most_pieces = 1'000'000;       // of an output, where it is not known how many there will be
constexpr std::size_t most_outputs = 1'000'000'000;  // where it is not known

/// What a run of so many outputs writes into state/: checkpoints, and densities that it keeps for pictures.
std::vector<std::string> names_in_state(std::size_t outputs);

/// "density/density_{0000..0012}.vti"; `count` files from 0.
std::string numbered_names(std::string_view before, std::size_t count, std::string_view ending);

}  // namespace gaussdrift::write
