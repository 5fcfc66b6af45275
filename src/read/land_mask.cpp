#include "read/land_mask.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "read/grid_file_error.hpp"

namespace gaussdrift::read {

std::vector<std::uint8_t> points_on_land(const std::vector<double>& numbers, bool marks_land, const std::string& mask) {
  std::vector<std::uint8_t> land(numbers.size());
  for (std::size_t p = 0; p < numbers.size(); ++p) {
    if (!std::isfinite(numbers[p]))
      throw GridFileError(fmt::format("the mask {} has no number at point {}", mask, p + 1),
                          "a mask has a number at every point, 0 or another one");
    land[p] = (numbers[p] != 0) == marks_land ? 1 : 0;
  }
  if (!land.empty() && std::all_of(land.begin(), land.end(), [](std::uint8_t one) { return one != 0; }))
    throw GridFileError(fmt::format("by the mask {} all points are land: its numbers are {} 0", mask,
                                    marks_land ? "other than" : "all"),
                        fmt::format("mask_is = \"{}\" says that numbers other than 0 are {}",
                                    marks_land ? "water" : "land", marks_land ? "water" : "land"));
  return land;
}

std::vector<std::uint8_t> hidden_by_either(std::vector<std::uint8_t> some, const std::vector<std::uint8_t>& others) {
  if (some.empty()) return others;
  for (std::size_t p = 0; p < others.size(); ++p) some[p] = some[p] || others[p] ? 1 : 0;
  return some;
}

}  // namespace gaussdrift::read
