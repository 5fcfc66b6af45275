// JSON as the verbs print it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

namespace gaussdrift::cli {

/// Names of files need not be UTF-8, JSON must.
inline std::string laid_out(const nlohmann::ordered_json& document) {
  return document.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace gaussdrift::cli
