// Points of ParaView files as tables.
#include "fuzz_target.hpp"
#include "gaussdrift/error.hpp"
#include "input/points_table.hpp"

namespace gaussdrift {

FUZZ_TARGET(points) {
  constexpr std::size_t memory = std::size_t{1} << 30;
  const std::filesystem::path file = fuzz::folder().write("points.vtp", text);
  for (const input::PointsColumns& columns : {input::PointsColumns{}, {{"u:1", "x"}, "weight", false}}) try {
      input::read_points_table(file, input::PointsRole::sources, memory, columns);
    } catch (const InputError&) {
    }
  try {
    input::read_named_columns(file, {"x", "y", "weight"}, memory);
  } catch (const InputError&) {
  }
}

}  // namespace gaussdrift
