#include "cli/missing_files.hpp"

#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "base/shell_word.hpp"
#include "cli/terminal.hpp"
#include "write/output_files.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> missing_pictures(const PictureStyle& style, const fs::path& folder, std::size_t outputs) {
  std::vector<std::string> missing;
  for (std::size_t index = 0; index < outputs; ++index)
    if (std::string picture = fmt::format("images/{}_{:04}.png", style.name, index); !fs::exists(folder / picture))
      missing.push_back(std::move(picture));
  // The error is drawn where the exact density is known; that may be nowhere.
  return style.shows_error && missing.size() == outputs ? std::vector<std::string>() : missing;
}

}  // namespace

void tell_missing_files(const Case& spec, const fs::path& folder, std::size_t outputs) {
  std::vector<std::string> missing;
  const auto add = [&](std::vector<std::string> more) {
    missing.insert(missing.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
  };
  for (const OutputFile& file : spec.output.files)
    add(write::missing_files(write::find_output_file(file.name), folder, outputs));
  for (const PictureStyle& style : spec.output.images) add(missing_pictures(style, folder, outputs));
  if (missing.empty()) return;
  note(
      "warning: {} of earlier outputs {} not there: {}{}. A run that goes on does not make {} again. Put {} back, or "
      "run "
      "the case once more: gaussdrift run {} --out DIR\n",
      missing.size() == 1 ? "a file" : fmt::format("{} files", missing.size()), missing.size() == 1 ? "is" : "are",
      (folder / missing.front()).string(), missing.size() == 1 ? "" : " and others",
      missing.size() == 1 ? "it" : "them", missing.size() == 1 ? "it" : "them",
      base::shell_word((folder / "run.toml").string()));
}

}  // namespace gaussdrift::cli
