// JSON that a test reads. Its parser takes a second to compile, so that it is compiled once and not in every test.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace gaussdrift {

/// Throws nlohmann::json::parse_error.
nlohmann::json parsed_json(const std::string& text);

}  // namespace gaussdrift
