// Writes files that exist whole or not at all: to a hidden file beside them first, which then takes their name.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string_view>

#include "write/part_file.hpp"

namespace gaussdrift::write {

/// Calls `write` with a new file in the same folder, checks that the disk took it all, and gives it the name. Returns
/// when the disk has file and name. On any failure the new file is removed, an older `file` stays as it was, and
/// FileError names the file and the reason of the system. Two processes that write the same file do not meet: one of
/// them is last. A link of that name is replaced and not followed.
/// Where `in_haste` says so the disk is not waited for: a loss of power may then leave a file that is not whole.
void write_atomically(const std::filesystem::path& file, const std::function<void(std::FILE*)>& write,
                      const InHaste& in_haste = {});

/// The same for a text.
void write_text(const std::filesystem::path& file, std::string_view text, const InHaste& in_haste = {});

/// Removes hidden files of this module that killed processes have left in `folder`, and nothing else. Files of
/// processes that live stay. What cannot be removed stays, too.
void remove_what_killed_processes_left(const std::filesystem::path& folder);

/// Whether a file of that name is a hidden file of this module.
bool is_part_name(std::string_view name);

}  // namespace gaussdrift::write
