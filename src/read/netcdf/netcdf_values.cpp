// The numbers of a time in a NetCDF file: unpacked, in the order of the grid, without those that mark missing data.
#include <algorithm>
#include <array>
#include <limits>

#include <fmt/format.h>

#include "read/grid_file_error.hpp"
#include "read/netcdf/netcdf_layout.hpp"
#include "read/netcdf/netcdf_marks.hpp"

namespace gaussdrift::read {

RawMarks::RawMarks(const NetcdfFile& file, const NetcdfVariable& variable) {
  const auto numbers = [&](const char* name) {
    const NetcdfAttribute* attribute = variable.find(name);
    return attribute ? attribute->numbers : std::vector<double>{};
  };
  fills_ = numbers("missing_value");
  const auto fill = numbers("_FillValue");
  fills_.insert(fills_.end(), fill.begin(), fill.end());
  if (fill.empty() && !variable.is_byte) fills_.push_back(file.usual_fill(variable));
  if (const auto range = numbers("valid_range"); range.size() == 2) least_ = range[0], most_ = range[1];
  if (const auto least = numbers("valid_min"); least.size() == 1) least_ = least[0];
  if (const auto most = numbers("valid_max"); most.size() == 1) most_ = most[0];
}

bool RawMarks::marks(double number) const {
  if (!(number >= least_ && number <= most_)) return true;  // NaN too
  return std::find(fills_.begin(), fills_.end(), number) != fills_.end();
}

NetcdfValues read_netcdf_values(const NetcdfFile& file, const NetcdfLayout& layout, std::size_t time, bool keep) {
  std::vector<std::size_t> start = layout.start, count(layout.lengths.size(), 1);
  if (layout.time) start[*layout.time] = time;
  for (const NetcdfAxis& axis : layout.axes) count[axis.along] = axis.points.size();
  // Between neighbours along each axis, in the numbers of the file.
  std::array<std::size_t, 3> stride{}, length{1, 1, 1};
  std::array<bool, 3> descends{};
  for (std::size_t k = 0; k < layout.axes.size(); ++k) {
    stride[k] = 1;
    for (std::size_t j = layout.axes[k].along + 1; j < count.size(); ++j) stride[k] *= count[j];
    length[k] = layout.axes[k].points.size();
    descends[k] = layout.axes[k].descends;
  }
  const std::size_t components = layout.arrays.size();
  NetcdfValues result;
  result.values.resize(layout.points() * components);
  const auto from = [&](std::size_t k, std::size_t i) { return (descends[k] ? length[k] - 1 - i : i) * stride[k]; };
  for (std::size_t component = 0; component < components; ++component) {
    const NetcdfVariable* variable = file.find(layout.arrays[component]);
    if (!variable || variable->dimensions.size() != count.size())
      throw GridFileError(fmt::format("{} has changed while it was read", file.name()));
    const std::vector<double> numbers = file.read(*variable, start, count);
    const RawMarks marks(file, *variable);
    const auto attribute = [&](const char* name, double usual) {
      const NetcdfAttribute* found = variable->find(name);
      return found && found->numbers.size() == 1 ? found->numbers[0] : usual;
    };
    const double scale = attribute("scale_factor", 1), offset = attribute("add_offset", 0);
    std::size_t point = 0;
    for (std::size_t c = 0; c < length[2]; ++c)
      for (std::size_t b = 0; b < length[1]; ++b) {
        const std::size_t row = from(2, c) + from(1, b);
        for (std::size_t a = 0; a < length[0]; ++a, ++point) {
          const double number = numbers[row + from(0, a)];
          double& value = result.values[point * components + component];
          const double plain = number < 0 ? number + variable->unsigned_span : number;
          value = layout.signs[component] * (plain * scale + offset);
          if (keep || !marks.marks(number)) continue;
          value = std::numeric_limits<double>::quiet_NaN();
          if (result.hidden.empty()) result.hidden.assign(layout.points(), 0);
          result.hidden[point] = 1;
        }
      }
  }
  if (layout.mask) result.hidden = hidden_by_either(std::move(result.hidden), read_netcdf_mask(file, layout, time));
  return result;
}

}  // namespace gaussdrift::read
