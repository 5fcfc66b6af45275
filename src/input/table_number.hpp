// One cell of a table as a number: read whole, or refused with the reason.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace gaussdrift::input {

struct CellNumber {
  std::optional<double> value;  // finite
  std::string problem{};        // if there is none: what the cell is instead,
  std::string remedy{};         // and how to write it, if that is known
};

/// Decimal numbers with a point, whatever the locale, and an exponent after e, E, d or D: Fortran writes 1.5D+00.
CellNumber read_cell(std::string_view cell);

}  // namespace gaussdrift::input
