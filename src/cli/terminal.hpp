// Prints results on standard output and all else on standard error. If a terminal, pipe or disk takes no more text,
// only the text is lost; a verb that is asked for results notices it at its end.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <cstdio>
#include <string_view>
#include <utility>

#include "base/printable.hpp"

namespace gaussdrift::cli {

/// Call it before any file is opened. A stream that was closed at the start must not share its number with a file of
/// the run. A reader that goes away must not end the run.
void prepare_streams();

/// Prints the text as it is, to steer the terminal on purpose. It does not throw if the stream is full or closed.
void put(std::FILE* stream, std::string_view text);

/// Prints the text made safe: nothing from cases, tables or file names steers the terminal.

template <class... Values>
void say(fmt::format_string<Values...> format, Values&&... values) {
  put(stdout, base::printable_lines(fmt::format(format, std::forward<Values>(values)...)));
}

/// Warnings, errors, remarks.
template <class... Values>
void note(fmt::format_string<Values...> format, Values&&... values) {
  put(stderr, base::printable_lines(fmt::format(format, std::forward<Values>(values)...)));
}

/// Columns of the terminal that the stream is; 0 if it is none, or does not tell.
std::size_t columns_of(std::FILE* stream);

/// Call it at the end: true if standard output has taken all text.
enum class Delivery { all, lost, reader_gone };
Delivery delivery();

}  // namespace gaussdrift::cli
