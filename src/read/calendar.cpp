#include "read/calendar.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <utility>

namespace gaussdrift::read {

namespace {

constexpr std::array<int, 12> month_lengths{31, 28, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31};
constexpr std::int64_t seconds_of_day = 86400, largest_year = 1'000'000;

struct Date {
  std::int64_t year = 0;
  int month = 1, day = 1;
};

std::int64_t floor_divide(std::int64_t a, std::int64_t b) { return a / b - (a % b < 0 ? 1 : 0); }

// Years begin in March, so that the day of the leap is the last one. The days of all calendars count from the same
// Gregorian and Julian day, 1970-01-01.
std::int64_t day_of(const Date& date, bool gregorian) {
  const std::int64_t year = date.year - (date.month <= 2 ? 1 : 0);
  const std::int64_t of_year = (153 * (date.month + (date.month > 2 ? -3 : 9)) + 2) / 5 + date.day - 1;
  const std::int64_t days = 365 * year + floor_divide(year, 4) + of_year;
  return gregorian ? days - floor_divide(year, 100) + floor_divide(year, 400) - 719468 : days - 719470;
}

// Fixed by the reform: the day after 1582-10-04 was 1582-10-15.
const std::int64_t reform = day_of({1582, 10, 15}, true);

bool is_leap(std::int64_t year, Calendar calendar) {
  if (calendar == Calendar::noleap || calendar == Calendar::days_360) return false;
  const auto divides = [&](std::int64_t n) { return year % n == 0; };
  if (calendar == Calendar::standard && year <= 1582) return divides(4);
  return divides(4) && (!divides(100) || divides(400));
}

int days_of_month(std::int64_t year, int month, Calendar calendar) {
  if (calendar == Calendar::days_360) return 30;
  return month_lengths[static_cast<std::size_t>(month - 1)] + (month == 2 && is_leap(year, calendar) ? 1 : 0);
}

std::optional<std::int64_t> day_of(const Date& date, Calendar calendar) {
  if (std::abs(date.year) > largest_year || date.month < 1 || date.month > 12 || date.day < 1 ||
      date.day > days_of_month(date.year, date.month, calendar))
    return std::nullopt;
  switch (calendar) {
    case Calendar::gregorian:
      return day_of(date, true);
    case Calendar::standard: {
      const std::int64_t day = day_of(date, true);
      if (day >= reform) return day;
      const std::int64_t julian = day_of(date, false);
      return julian < reform ? std::optional(julian) : std::nullopt;  // the ten days that never were
    }
    case Calendar::noleap: {
      std::int64_t day = 365 * date.year + date.day - 1;
      for (int month = 1; month < date.month; ++month) day += month_lengths[static_cast<std::size_t>(month - 1)];
      return day;
    }
    case Calendar::days_360:
      return 360 * date.year + 30 * (date.month - 1) + date.day - 1;
  }
  return std::nullopt;
}

/// Found by halves, since calendars only tell the day of a date.
Date date_of(std::int64_t day, Calendar calendar) {
  const auto first_of = [&](std::int64_t year, int month) { return *day_of({year, month, 1}, calendar); };
  std::int64_t low = -largest_year, high = largest_year;  // the first of low <= day
  while (high - low > 1) {
    const std::int64_t middle = floor_divide(low + high, 2);
    (first_of(middle, 1) <= day ? low : high) = middle;
  }
  int month = 12;
  while (month > 1 && first_of(low, month) > day) --month;
  std::int64_t first = first_of(low, month);
  int of_month = static_cast<int>(day - first) + 1;
  if (calendar == Calendar::standard && low == 1582 && month == 10 && of_month > 4) of_month += 10;
  return {low, month, of_month};
}

/// Reads from the front of a text.
class Front {
 public:
  explicit Front(std::string_view text) : text_(text) {}
  bool skip(char c) {
    if (text_.empty() || text_.front() != c) return false;
    text_.remove_prefix(1);
    return true;
  }
  void skip_blanks() {
    while (skip(' ') || skip('\t')) continue;
  }
  std::optional<std::int64_t> whole(std::size_t most_digits) {
    std::size_t digits = 0;
    std::int64_t value = 0;
    for (; digits < text_.size() && digits < most_digits && is_digit(text_[digits]); ++digits)
      value = 10 * value + (text_[digits] - '0');
    if (digits == 0) return std::nullopt;
    text_.remove_prefix(digits);
    last_digits_ = digits;
    return value;
  }
  /// ".25"
  double fraction() {
    double value = 0, unit = 0.1;
    if (!skip('.')) return 0;
    for (; !text_.empty() && is_digit(text_.front()); text_.remove_prefix(1), unit /= 10)
      value += unit * (text_.front() - '0');
    return value;
  }
  std::size_t last_digits() const { return last_digits_; }
  std::string_view rest() const { return text_; }

 private:
  static bool is_digit(char c) { return c >= '0' && c <= '9'; }
  std::string_view text_;
  std::size_t last_digits_ = 0;
};

/// "+01:00", "-0330", "+1", "Z", "UTC": seconds before Greenwich; nothing for others.
std::optional<double> read_zone(std::string_view text) {
  std::string name;
  for (const char c : text) name += static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  if (name.empty() || name == "Z" || name == "UTC" || name == "GMT") return 0;
  Front front(text);
  const bool behind = front.skip('-');
  if (!behind) front.skip('+');
  std::int64_t hours = front.whole(4).value_or(99), minutes = 0;
  if (front.last_digits() > 2) minutes = hours % 100, hours /= 100;
  if (front.skip(':')) minutes = front.whole(2).value_or(99);
  if (!front.rest().empty() || hours > 24 || minutes > 59) return std::nullopt;
  return (behind ? -1. : 1.) * static_cast<double>(3600 * hours + 60 * minutes);
}

std::string_view trimmed(std::string_view text) {
  const auto blank = [](char c) { return std::isspace(static_cast<unsigned char>(c)) || c == '\0'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace

std::optional<Calendar> find_calendar(std::string_view name) {
  std::string lower;
  for (const char c : trimmed(name)) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::array<std::pair<std::string_view, Calendar>, 7> known{{{"", Calendar::standard},
                                                                        {"standard", Calendar::standard},
                                                                        {"gregorian", Calendar::standard},
                                                                        {"proleptic_gregorian", Calendar::gregorian},
                                                                        {"noleap", Calendar::noleap},
                                                                        {"365_day", Calendar::noleap},
                                                                        {"360_day", Calendar::days_360}}};
  for (const auto& [word, calendar] : known)
    if (word == lower) return calendar;
  return std::nullopt;
}

double seconds_between(const Moment& from, const Moment& to) {
  return static_cast<double>((to.day - from.day) * seconds_of_day) + (to.seconds - from.seconds);
}

Moment later(const Moment& moment, double seconds) {
  const double all = moment.seconds + seconds;
  constexpr double most_days = 3e8;
  const double days = std::clamp(std::floor(all / seconds_of_day), -most_days, most_days);
  return {moment.day + static_cast<std::int64_t>(days), all - days * seconds_of_day};
}

std::optional<Moment> read_date(std::string_view text, Calendar calendar) {
  Front front(trimmed(text));
  const bool before_christ = front.skip('-');
  const auto year = front.whole(6);
  if (!year || !front.skip('-')) return std::nullopt;
  const auto month = front.whole(2);
  if (!month || !front.skip('-')) return std::nullopt;
  const auto day = front.whole(2);
  if (!day) return std::nullopt;
  const auto days =
      day_of(Date{before_christ ? -*year : *year, static_cast<int>(*month), static_cast<int>(*day)}, calendar);
  if (!days) return std::nullopt;
  double seconds = 0;
  if (!front.skip('T')) front.skip_blanks();
  if (const auto hour = front.whole(2)) {
    std::int64_t minute = 0, second = 0;
    double part = 0;
    if (front.skip(':')) {
      minute = front.whole(2).value_or(60);
      if (front.skip(':')) {
        second = front.whole(2).value_or(61);
        part = front.fraction();
      }
    }
    if (*hour > 24 || minute > 59 || second > 60) return std::nullopt;
    seconds = static_cast<double>(3600 * *hour + 60 * minute + second) + part;
  }
  front.skip_blanks();
  const auto zone = read_zone(front.rest());
  if (!zone) return std::nullopt;
  return later({*days, 0}, seconds - *zone);
}

std::string written_date(const Moment& moment, Calendar calendar) {
  const Moment shown = later({moment.day, 0}, std::round(moment.seconds * 1000) / 1000);
  const Date date = date_of(shown.day, calendar);
  const auto minutes = static_cast<int>(shown.seconds / 60);
  const double seconds = shown.seconds - 60 * minutes;
  const std::string clock =
      fmt::format("{:04}-{:02}-{:02} {:02}:{:02}", date.year, date.month, date.day, minutes / 60, minutes % 60);
  return seconds < 0.0005 ? clock : fmt::format("{}:{:g}", clock, seconds);
}

std::optional<double> seconds_of_unit(std::string_view name) {
  std::string lower;
  for (const char c : trimmed(name)) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  constexpr std::array<std::pair<std::string_view, double>, 21> known{
      {{"d", 86400},          {"day", 86400},  {"days", 86400}, {"h", 3600},    {"hr", 3600},
       {"hrs", 3600},         {"hour", 3600},  {"hours", 3600}, {"min", 60},    {"mins", 60},
       {"minute", 60},        {"minutes", 60}, {"s", 1},        {"sec", 1},     {"secs", 1},
       {"second", 1},         {"seconds", 1},  {"ms", 1e-3},    {"msec", 1e-3}, {"millisecond", 1e-3},
       {"milliseconds", 1e-3}}};
  for (const auto& [word, seconds] : known)
    if (word == lower) return seconds;
  return std::nullopt;
}

std::string name_of_unit(double seconds) {
  constexpr std::array<std::pair<double, const char*>, 5> names{
      {{86400, "day"}, {3600, "hour"}, {60, "minute"}, {1, "second"}, {1e-3, "millisecond"}}};
  for (const auto& [length, name] : names)
    if (seconds == length) return name;
  return "unit";
}

std::optional<TimeUnits> read_time_units(std::string_view text, Calendar calendar) {
  text = trimmed(text);
  std::string lower;
  for (const char c : text) lower += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const std::size_t since = lower.find(" since ");
  const auto seconds = seconds_of_unit(text.substr(0, since));
  if (!seconds) return std::nullopt;
  TimeUnits units{*seconds, {}};
  if (since == std::string::npos) return units;
  units.since = read_date(text.substr(since + 7), calendar);
  if (!units.since) return std::nullopt;
  return units;
}

}  // namespace gaussdrift::read
