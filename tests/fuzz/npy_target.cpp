// Arrays of NumPy as tables of points.
#include <algorithm>

#include "fuzz_target.hpp"
#include "gaussdrift/error.hpp"
#include "input/points_table.hpp"

namespace gaussdrift {

FUZZ_TARGET(npy) {
  constexpr std::size_t memory = std::size_t{1} << 30;
  const std::string bytes = std::string("\x93NUMPY") + std::string(text.substr(std::min<std::size_t>(6, text.size())));
  for (const input::PointsColumns& columns : {input::PointsColumns{}, {{}, "1", false}, {{"1", "2"}, "3", false}}) try {
      input::parse_points_table(bytes, "S.npy", input::PointsRole::sources, memory, columns);
    } catch (const InputError&) {
    }
  try {
    input::parse_named_columns(bytes, "S.npy", {"x", "y", "u"}, memory);
  } catch (const InputError&) {
  }
}

}  // namespace gaussdrift
