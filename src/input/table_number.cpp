#include "input/table_number.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <system_error>

#include "base/number.hpp"
#include "base/printable.hpp"

namespace gaussdrift::input {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Fortran drops the letter of an exponent with three digits: 1.5-103.
bool lacks_its_letter(std::string_view number) {
  const std::size_t sign = number.find_last_of("+-");
  return sign != std::string_view::npos && sign > 0 && number.size() == sign + 4 &&
         (is_digit(number[sign - 1]) || number[sign - 1] == '.') &&
         number.find_first_not_of("0123456789.", 0) == sign &&
         std::all_of(number.begin() + static_cast<std::ptrdiff_t>(sign) + 1, number.end(), is_digit);
}

CellNumber not_a_number(std::string_view cell) {
  const std::string problem = fmt::format("{} is not a number", base::in_quotes(cell));
  std::string_view bare = cell;
  if (bare.front() == '-' || bare.front() == '+') bare.remove_prefix(1);
  if (lacks_its_letter(bare)) return {{}, problem, "the e of its exponent is missing, as Fortran leaves it out"};
  if (cell.find_first_not_of('*') == std::string_view::npos)
    return {{}, problem, "Fortran writes stars where a number does not fit"};
  if (std::count(cell.begin(), cell.end(), ',') == 1 && cell.find_first_not_of("0123456789.,+-eE") == std::string::npos)
    return {{}, problem, "the decimal sign is a point, not a comma"};
  if (cell.find('#') != std::string_view::npos)
    return {{}, problem, "a comment has a line of its own, or a blank before its #"};
  return {{}, problem, ""};
}

}  // namespace

CellNumber read_cell(std::string_view cell) {
  if (cell.empty()) return {{}, "there is no value"};
  const std::string fortran = base::with_e(cell);
  const auto value = base::read_number<double>(fortran.empty() ? cell : std::string_view(fortran));
  if (value && std::isfinite(*value)) return {value};
  if (value) return {{}, fmt::format("{} is not finite", base::printable(base::shortened(cell, 24)))};
  double ignored = 0;
  const auto [rest, error] = std::from_chars(cell.data(), cell.data() + cell.size(), ignored);
  if (error == std::errc::result_out_of_range && rest == cell.data() + cell.size())
    return {{}, fmt::format("{} is outside the range of double precision", base::in_quotes(cell))};
  return not_a_number(cell);
}

}  // namespace gaussdrift::input
