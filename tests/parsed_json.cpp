#include "parsed_json.hpp"

namespace gaussdrift {

nlohmann::json parsed_json(const std::string& text) { return nlohmann::json::parse(text); }

}  // namespace gaussdrift
