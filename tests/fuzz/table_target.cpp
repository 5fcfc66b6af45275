// Tables of comma-separated values: points of sums, samples of velocities.
#include "fuzz_target.hpp"
#include "gaussdrift/error.hpp"
#include "input/points_table.hpp"
#include "input/sample_table.hpp"

namespace gaussdrift {

namespace {

template <class Work>
void answered(const Work& work) {
  try {
    work();
  } catch (const InputError&) {
  } catch (const FileError&) {
  }
}

}  // namespace

FUZZ_TARGET(table) {
  constexpr std::size_t memory = std::size_t{1} << 30;
  for (const input::PointsRole role : {input::PointsRole::sources, input::PointsRole::targets}) {
    answered([&] { input::parse_points_table(text, "table.csv", role, memory); });
    answered([&] { input::parse_points_table(text, "table.csv", role, memory, {{"x", "y"}, "", false}); });
  }
  answered([&] { input::parse_named_columns(text, "table.csv", {"x", "y", "u"}, memory); });
  answered([&] {
    input::read_sample_table(fuzz::folder().write("table.csv", text), {"x", "y", "u", "v"}, 2,
                             input::Coinciding::refused);
  });
}

}  // namespace gaussdrift
