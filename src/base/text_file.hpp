// The whole text of a file that a user names: bounded, and with a clear answer where it is no file of text at all.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>

namespace gaussdrift::base {

/// The size of what comes through a pipe is not known beforehand; more than this is refused.
constexpr std::size_t most_piped = std::size_t{1} << 30;

/// Reads the file to its end. `kind` says what it should be: "a case file". Pipes are read (`<(...)`, /dev/stdin).
/// Throws FileError for folders, devices, sockets, pipes to which nobody writes, and what the system refuses;
/// InputError as soon as there are more than `most_bytes`, before they are read.
std::string read_text_file(const std::filesystem::path& file, std::string_view kind, std::size_t most_bytes);

/// The same of what comes through standard input, which messages call so. A terminal is refused: it is a device.
std::string read_standard_input(std::string_view kind, std::size_t most_bytes);

/// "a folder", "a device", ... for what is neither a regular file nor a pipe; empty for those and for what is not
/// there.
std::string what_else_it_is(const std::filesystem::path& file);

}  // namespace gaussdrift::base
