// The text of a table, before anything in it is understood: read within a limit, and refused with its true reason if
// it is no text.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace gaussdrift::input {

/// Throws FileError if the file cannot be read, InputError if it is larger than `memory_limit`.
std::string read_text(const std::filesystem::path& file, std::size_t memory_limit);

/// What the data are if they are no text, and how they become a table: "a NetCDF file; ...". Empty for text.
std::string foreign_format(std::string_view data);

}  // namespace gaussdrift::input
