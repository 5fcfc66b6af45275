// A variable beside the data that says where there is land: mask_rho, tmask, sea_binary_mask.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <limits>
#include <sstream>

#include "read/grid_file_error.hpp"
#include "read/netcdf/netcdf_layout.hpp"
#include "read/netcdf/netcdf_marks.hpp"

namespace gaussdrift::read {

namespace {

/// What the file says of numbers other than 0; as_the_file_says: nothing.
MaskIs said_by(const NetcdfVariable& variable) {
  const std::string standard = variable.text("standard_name");
  if (standard == "land_binary_mask") return MaskIs::land;
  if (standard == "sea_binary_mask") return MaskIs::water;
  const NetcdfAttribute* flags = variable.find("flag_values");
  std::istringstream words(variable.text("flag_meanings"));
  std::string word;
  for (std::size_t i = 0; flags && words >> word && i < flags->numbers.size(); ++i) {
    if (flags->numbers[i] == 0) continue;
    if (word == "land") return MaskIs::land;
    if (word == "water" || word == "sea" || word == "ocean") return MaskIs::water;
  }
  return MaskIs::as_the_file_says;
}

}  // namespace

NetcdfMask netcdf_mask(const NetcdfFile& file, const NetcdfLayout& layout, const GridRequest& request) {
  const NetcdfVariable* variable = file.find(request.mask);
  const std::vector<std::size_t>& of_arrays = file.find(layout.arrays[0])->dimensions;
  if (!variable || !variable->holds_numbers)
    throw GridFileError(fmt::format("{} has no array \"{}\"{}, which mask names", file.name(), request.mask,
                                    variable ? " of numbers" : ""));
  NetcdfMask mask{.name = request.mask, .along = {}};
  std::vector<std::string> strange;
  for (const std::size_t k : variable->dimensions) {
    const auto at = std::find(of_arrays.begin(), of_arrays.end(), k);
    if (at != of_arrays.end())
      mask.along.emplace_back(static_cast<std::size_t>(at - of_arrays.begin()));
    else if (file.dimensions()[k].length == 1)
      mask.along.emplace_back(std::nullopt);
    else
      strange.push_back(file.dimensions()[k].name);
  }
  const bool in_plane = std::all_of(layout.axes.begin(), layout.axes.begin() + 2, [&](const NetcdfAxis& axis) {
    return std::find(mask.along.begin(), mask.along.end(), std::optional(axis.along)) != mask.along.end();
  });
  if (!strange.empty() || !in_plane)
    throw GridFileError(
        fmt::format(
            "the mask \"{}\" of {} {}, and \"{}\" does not", request.mask, file.name(),
            strange.empty() ? "is the same along x or y" : fmt::format("lies along {}", fmt::join(strange, " and ")),
            layout.arrays[0]),
        "a mask lies along x and y of the data; in a staggered grid each kind of points has a mask of its own");
  const MaskIs said = said_by(*variable);
  const MaskIs is = request.mask_is != MaskIs::as_the_file_says ? request.mask_is : said;
  mask.marks_land = is == MaskIs::land;
  return mask;
}

std::vector<std::uint8_t> read_netcdf_mask(const NetcdfFile& file, const NetcdfLayout& layout, std::size_t time) {
  const NetcdfMask& mask = *layout.mask;
  const NetcdfVariable* variable = file.find(mask.name);
  if (!variable || variable->dimensions.size() != mask.along.size())
    throw GridFileError(fmt::format("{} has changed while it was read", file.name()));
  std::vector<std::size_t> start(mask.along.size(), 0), count(mask.along.size(), 1);
  std::array<std::size_t, 3> stride{}, length{1, 1, 1};
  for (std::size_t d = 0; d < mask.along.size(); ++d)
    if (mask.along[d]) start[d] = layout.time && mask.along[d] == layout.time ? time : layout.start[*mask.along[d]];
  for (std::size_t k = 0; k < layout.axes.size(); ++k) length[k] = layout.axes[k].points.size();
  for (std::size_t d = 0; d < mask.along.size(); ++d)
    for (std::size_t k = 0; k < layout.axes.size(); ++k)
      if (mask.along[d] == layout.axes[k].along) count[d] = length[k];
  std::size_t step = 1;
  for (std::size_t d = mask.along.size(); d-- > 0; step *= count[d])
    for (std::size_t k = 0; k < layout.axes.size(); ++k)
      if (mask.along[d] == layout.axes[k].along) stride[k] = step;
  const std::vector<double> numbers = file.read(*variable, start, count);
  const RawMarks marks(file, *variable);
  std::vector<double> in_order;
  in_order.reserve(layout.points());
  const auto from = [&](std::size_t k, std::size_t i) {
    return (k < layout.axes.size() && layout.axes[k].descends ? length[k] - 1 - i : i) * stride[k];
  };
  for (std::size_t c = 0; c < length[2]; ++c)
    for (std::size_t b = 0; b < length[1]; ++b)
      for (std::size_t a = 0; a < length[0]; ++a) {
        const double number = numbers[from(2, c) + from(1, b) + from(0, a)];
        in_order.push_back(marks.marks(number) ? std::numeric_limits<double>::quiet_NaN() : number);
      }
  return points_on_land(in_order, mask.marks_land, fmt::format("{} of {}", mask.name, file.name()));
}

}  // namespace gaussdrift::read
