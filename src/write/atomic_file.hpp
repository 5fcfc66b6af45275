// Writes files that exist whole or not at all: to "<name>.part" first, which is then renamed.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace gaussdrift::write {

/// Calls `write(part)` with the path beside `file`, checks that the disk took it all, and renames. On any failure the
/// part is removed, an older `file` stays as it was, and FileError names the file and the reason of the system.
void write_atomically(const std::filesystem::path& file,
                      const std::function<void(const std::filesystem::path&)>& write);

/// The same for a text.
void write_text(const std::filesystem::path& file, std::string_view text);

}  // namespace gaussdrift::write
