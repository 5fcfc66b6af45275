// The text of a case with other values, as --set gives them: comments and all else stay as they are.
#pragma once

#include <string>
#include <vector>

namespace gaussdrift::input {

/// `settings` are "table.key=value", which a reader has accepted as overrides of `text`. The value of a key that is there is
/// replaced; other keys are put at the end of their table, and other tables at the end of the text. Throws InputError where a
/// table is written within a line.
std::string with_settings(std::string text, const std::vector<std::string>& settings);

}  // namespace gaussdrift::input
