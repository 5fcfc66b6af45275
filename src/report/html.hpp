// Pieces of the page: texts, numbers and pictures as HTML, and members of JSON that may be missing.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "base/escaped.hpp"

namespace gaussdrift::report {

using json = nlohmann::ordered_json;

using base::escaped;
std::string base64(const std::string& bytes);

/// A dash for what is no number.
std::string number(const json& value, const char* format = "{:.3g}");

/// A member, or null.
json get(const json& object, const char* name);

/// Also of what is no number.
bool is_zero(const json& value);

}  // namespace gaussdrift::report
