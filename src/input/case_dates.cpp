#include "input/case_dates.hpp"

#include <variant>

#include "field/gridded/grid_data.hpp"

namespace gaussdrift::input {

namespace {

const GridDates* dates_of(const GridFileSpec& file) {
  return file.data && file.data->dates ? &*file.data->dates : nullptr;
}

/// Those of the first data that have some, in the order in which a case is read.
const GridDates* dates_of(const Case& spec) {
  for (const VelocitySpec& part : spec.velocity)
    if (const auto* file = std::get_if<FileVelocitySpec>(&part))
      if (const GridDates* dates = dates_of(*file)) return dates;
  for (const DensitySpec& part : spec.density)
    if (const auto* file = std::get_if<FileDensitySpec>(&part))
      if (const GridDates* dates = dates_of(*file)) return dates;
  return nullptr;
}

}  // namespace

std::optional<double> time_of_date(const Case& spec, const std::string& date) {
  const GridDates* dates = dates_of(spec);
  return dates ? dates->time(date) : std::nullopt;
}

}  // namespace gaussdrift::input
