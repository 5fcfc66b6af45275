// What the program says: results on standard output, all else on standard error. A terminal, pipe or disk that takes
// no more text costs the text and nothing else; a verb that is asked for results notices it at its end.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <string_view>
#include <utility>

#include "base/printable.hpp"

namespace gaussdrift::cli {

/// Before any file is opened: a stream that was closed at the start must not share its number with a file of the run,
/// and a reader that went away must not end it.
void prepare_streams();

/// As it is, for what steers the terminal on purpose. Never throws over a stream that is full or closed.
void put(std::FILE* stream, std::string_view text);

/// Printable: what cases, tables and names of files bring along steers no terminal.

template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  put(stdout, base::printable_lines(fmt::format(format, std::forward<Values>(values)...)));
}

/// Warnings, errors, remarks.
template <class... Values>
void note(fmt::format_string<Values...> format, Values&&... values) {
  put(stderr, base::printable_lines(fmt::format(format, std::forward<Values>(values)...)));
}

/// Whether standard output has taken all that was said, now that nothing more comes.
enum class Delivery { all, lost, reader_gone };
Delivery delivery();

}  // namespace gaussdrift::cli
