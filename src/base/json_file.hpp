// JSON from a folder that may be a stranger's: bounded, and with the reason where it is not what it should be.
// JSON that is made here begins as object() or array(). A null that becomes one at its first member ends the program by a
// segmentation fault where memory runs out just then: nlohmann's operator[] leaves an object that points nowhere.
#pragma once

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

namespace gaussdrift::base {

/// The largest files that are read. The numbers of a run grow with its outputs; the others are lists of names.
constexpr std::size_t most_json_of_numbers = std::size_t{1} << 28, most_json_of_names = 1'000'000;

/// The object that a text is. Takes memory and time in proportion to it. Throws std::out_of_range with place and reason
/// where it is none, or nested deeply.
nlohmann::ordered_json json_in(std::string_view text);

/// The object in the file; none if there is no such file. Takes memory and time in proportion to the file, and calls no
/// function as deep as it is nested. Throws FileError with place and reason for all else that may be there: a link, a
/// pipe, a folder, more than `most_bytes`, deep nesting, no JSON, JSON that is no object. `remedy` ends the message.
std::optional<nlohmann::ordered_json> json_if_there(const std::filesystem::path& file, std::size_t most_bytes,
                                                    std::string_view remedy);

}  // namespace gaussdrift::base
