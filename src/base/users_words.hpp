// Turns messages of the libraries fgtd, farfield and rbf, which are for programmers, into words for users of the program.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>

namespace gaussdrift::base {

/// Names of a library and what the user wrote for them: {"Options::tolerance = ", "--tolerance "}.
using Words = std::initializer_list<std::pair<std::string_view, std::string_view>>;

/// The message without the library's own name at its beginning, each of `words` replaced.
inline std::string in_users_words(std::string message, Words words) {
  for (const std::string_view library : {"fgtd: ", "farfield: ", "rbf: "})
    if (message.rfind(library, 0) == 0) message.erase(0, library.size());
  for (const auto& [name, word] : words)
    for (std::size_t at = message.find(name); at != std::string::npos; at = message.find(name, at + word.size()))
      message.replace(at, name.size(), word);
  return message;
}

}  // namespace gaussdrift::base
