// The message of an error.
#pragma once

#include <string>

namespace gaussdrift {

/// What a call threw, or "".
template <class Kind, class Call>
std::string message_of(const Call& call) {
  try {
    call();
  } catch (const Kind& error) {
    return error.what();
  }
  return "";
}

}  // namespace gaussdrift
