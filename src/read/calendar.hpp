// Calendars of data: "hours since 1900-01-01", and what date that is.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace gaussdrift::read {

enum class Calendar {
  standard,   // Gregorian from 1582-10-15 on, Julian before
  gregorian,  // at all times ("proleptic")
  noleap,     // 365 days a year
  days_360    // twelve months of 30 days
};
/// By the names of the CF conventions; nothing for others.
std::optional<Calendar> find_calendar(std::string_view name);

/// A moment: whole days since some day of the calendar, and seconds after.
struct Moment {
  std::int64_t day = 0;
  double seconds = 0;
};
double seconds_between(const Moment& from, const Moment& to);
Moment later(const Moment& moment, double seconds);

/// "2020-01-03", "2020-1-3 12:30:00.5", "2020-01-03T12:30Z", "... +01:00". Nothing if it is no date of that calendar.
std::optional<Moment> read_date(std::string_view text, Calendar calendar);
/// "2020-01-03 12:30", with seconds where they are not 0.
std::string written_date(const Moment& moment, Calendar calendar);

/// "h", "hours", "days", "min", "seconds", ...: how many seconds; nothing for others. Months and years are none: they have
/// no one length.
std::optional<double> seconds_of_unit(std::string_view name);
/// "second", "minute", "hour", "day" of as many seconds; else "unit".
std::string name_of_unit(double seconds);

/// What the units of a time say.
struct TimeUnits {
  double seconds = 1;             // of one unit
  std::optional<Moment> since{};  // nothing: no date
};
/// "hours since 1900-01-01 00:00:0.0", "days". Nothing if it is not understood.
std::optional<TimeUnits> read_time_units(std::string_view text, Calendar calendar);

}  // namespace gaussdrift::read
