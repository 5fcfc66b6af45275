#include "read/netcdf/netcdf_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "read/grid_file_error.hpp"
#include "read/velocity_units.hpp"

namespace gaussdrift::read {

namespace {

constexpr std::size_t most_times = 10'000'000;

std::string plural(double seconds) { return name_of_unit(seconds) + "s"; }

}  // namespace

void NetcdfTimes::add(std::size_t file, const std::string& name, const NetcdfLayout& layout) {
  if (file == 0) {
    units_ = layout.time_units;
    calendar_ = layout.calendar;
    clock_ = layout.clock;
  }
  double scale = 1, offset = 0;  // to the numbers of the first file
  if (layout.time_units != units_ || layout.calendar != calendar_) {
    if (!clock_ || !clock_->since || !layout.clock || !layout.clock->since || layout.calendar != calendar_)
      throw GridFileError(
          fmt::format("the times of {} are in \"{}\", those before in \"{}\"", name, layout.time_units, units_),
          "files of a series have one calendar, and times with dates");
    scale = layout.clock->seconds / clock_->seconds;
    offset = seconds_between(*clock_->since, *layout.clock->since) / clock_->seconds;
  }
  if (stamps_.size() + layout.times.size() > most_times)
    throw GridFileError(fmt::format("{} has more than {} snapshots", series_, most_times), "leave times out");
  for (std::size_t i = 0; i < layout.times.size(); ++i) {
    const double number = layout.times[i] * scale + offset;
    std::string written = clock_ && clock_->since
                              ? written_date(later(*clock_->since, number * clock_->seconds), calendar_)
                              : fmt::format("time {:.10g}", number);
    stamps_.push_back({number, std::move(written), file, i});
  }
}

double NetcdfTimes::scene_time(double number) const {
  if (request_.clock && request_.clock->unit_number) return (number - start_) / *request_.clock->unit_number;
  const double unit = clock_ ? clock_->seconds : 1;
  // Days as decimal fractions are rounded: whole milliseconds are meant.
  double seconds = (number - start_) * unit;
  const double whole = std::round(seconds * 1000) / 1000;
  const double rounding =
      4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(number), std::abs(start_)) * unit;
  if (clock_ && std::abs(seconds - whole) <= rounding) seconds = whole;
  return scene_seconds_ > 0 ? seconds / scene_seconds_ : number - start_;
}

void NetcdfTimes::choose_start(const std::vector<Stamp>& stamps) {
  start_ = stamps.front().time;
  if (!request_.clock) return;
  if (request_.clock->start_number) start_ = *request_.clock->start_number;
  if (request_.clock->start.empty()) return;
  if (!clock_ || !clock_->since)
    throw GridFileError(fmt::format("{} has no dates: its times are in \"{}\"", series_, units_),
                        "time = { start = NUMBER } names a time as the file has it");
  const auto date = read_date(request_.clock->start, calendar_);
  if (!date)
    throw GridFileError(fmt::format("\"{}\" is no date of the calendar of {}", request_.clock->start, series_),
                        "a date is written as in \"2020-01-03\" or \"2020-01-03 12:30\"");
  start_ = seconds_between(*clock_->since, *date) / clock_->seconds;
}

std::vector<Stamp> NetcdfTimes::settled(std::vector<DataWarning>& warnings) {
  std::stable_sort(stamps_.begin(), stamps_.end(), [](const Stamp& a, const Stamp& b) { return a.time < b.time; });
  std::vector<Stamp> stamps = stamps_;
  choose_start(stamps);
  if (clock_) scene_seconds_ = clock_->seconds;
  if (request_.clock && !request_.clock->unit.empty()) {
    if (!clock_)
      throw GridFileError(fmt::format("the times of {} have no unit that is known: \"{}\"", series_, units_),
                          "time = { unit = NUMBER } says how much of them is 1 in the scene");
    scene_seconds_ = *seconds_of_unit(request_.clock->unit);
  }
  for (Stamp& stamp : stamps) stamp.time = scene_time(stamp.time);
  settle_duplicates(stamps, request_.duplicates, series_);
  look_for_gaps(stamps, request_.gaps, series_, warnings);
  return stamps;
}

std::string NetcdfTimes::describe() const {
  if (stamps_.size() < 2 && !request_.clock) return "";
  std::string start = fmt::format("time {:.10g} of the file", start_);
  if (clock_ && clock_->since) start = written_date(later(*clock_->since, start_ * clock_->seconds), calendar_);
  const bool scaled = request_.clock && request_.clock->unit_number;
  return fmt::format("t = 0 at {}{}", start, scene_seconds_ > 0 && !scaled ? ", in " + plural(scene_seconds_) : "");
}

std::optional<GridDates> NetcdfTimes::dates() const {
  if (!clock_ || !clock_->since || stamps_.size() < 2) return std::nullopt;
  const double scaled =
      request_.clock && request_.clock->unit_number ? *request_.clock->unit_number * clock_->seconds : scene_seconds_;
  const Moment zero = later(*clock_->since, start_ * clock_->seconds);
  return GridDates{
      [zero, scaled, calendar = calendar_](double t) { return written_date(later(zero, t * scaled), calendar); },
      [zero, scaled, calendar = calendar_](const std::string& date) -> std::optional<double> {
        const auto moment = read_date(date, calendar);
        return moment ? std::optional(seconds_between(zero, *moment) / scaled) : std::nullopt;
      }};
}

namespace {

const std::string degree_unit = "degree";  // of length_unit()

}  // namespace

double NetcdfTimes::velocity_factor(const NetcdfLayout& layout, std::vector<DataWarning>& warnings) const {
  if (request_.most_components == 1) return 1;
  const bool converts = request_.clock && !request_.clock->unit.empty();
  const bool scaled = request_.clock && request_.clock->unit_number;
  std::optional<VelocityUnits> units;
  for (std::size_t c = 0; c < layout.units.size(); ++c) {
    const auto of_component = read_velocity_units(layout.units[c]);
    if (c > 0 && (of_component.has_value() != units.has_value() ||
                  (units && (units->length != of_component->length || units->seconds != of_component->seconds))))
      throw GridFileError(
          fmt::format("{} has velocities in \"{}\" and in \"{}\"", series_, layout.units[0], layout.units[c]),
          "bring the components to one unit");
    units = of_component;
  }
  if (!units) {
    if (converts)
      warnings.push_back({fmt::format("{} has velocities in \"{}\", which is no length per time that is known", series_,
                                      layout.units[0]),
                          "they are taken as written, as lengths per unit of time of the scene"});
    return 1;
  }
  if (request_.on_sphere && units->length != "m")
    warnings.push_back({fmt::format("{} has velocities in \"{}\"", series_, layout.units[0]),
                        "they are taken as written, in the unit of domain.radius, which is a metre by default"});
  const std::string& wanted = request_.on_sphere ? degree_unit : units->length;
  for (const NetcdfAxis& axis : layout.axes)
    if (const std::string length = length_unit(axis.units); !length.empty() && length != wanted) {
      warnings.push_back(
          {fmt::format("{} has velocities in \"{}\", and {} in \"{}\"", series_, layout.units[0], axis.name,
                       axis.units),
           "they are taken as written: particles go as far in these coordinates as the numbers say. Bring "
           "them to one unit of length in the file"});
      break;
    }
  if (converts) return scene_seconds_ / units->seconds;
  if (!scaled && clock_ && stamps_.size() > 1 && clock_->seconds != units->seconds)
    warnings.push_back(
        {fmt::format("{} has velocities in \"{}\", and its times count in {}", series_, layout.units[0],
                     plural(clock_->seconds)),
         fmt::format(
             "both are taken as written, so particles go {:g} times the right way. time = {{ unit = \"{}\" }} counts "
             "both in {}",
             units->seconds / clock_->seconds, name_of_unit(clock_->seconds), plural(clock_->seconds))});
  return 1;
}

}  // namespace gaussdrift::read
