// A mask: an array beside the data that says where there is water and where there is land.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::read {

/// What numbers other than 0 mean.
enum class MaskIs {
  as_the_file_says,  // water, unless attributes of the array say that they are land
  water,             // as in NEMO, ROMS and most models of oceans
  land
};
constexpr std::array<std::string_view, 3> mask_names{"", "water", "land"};

/// 1 for each point that is land: where the number is 0, or with `marks_land` where it is another one.
/// mask: "tmask of ocean.nc", for messages. Throws GridFileError where a number is none, and where all points are land.
std::vector<std::uint8_t> points_on_land(const std::vector<double>& numbers, bool marks_land, const std::string& mask);

/// The points that are hidden by one of both. Empty: none is.
std::vector<std::uint8_t> hidden_by_either(std::vector<std::uint8_t> some, const std::vector<std::uint8_t>& others);

}  // namespace gaussdrift::read
