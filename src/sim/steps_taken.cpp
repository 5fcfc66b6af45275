#include "sim/steps_taken.hpp"

#include <algorithm>
#include <cstdint>
#include <stdexcept>

namespace gaussdrift {

namespace {

constexpr double most_steps = 1e15;  // of an interval, so that they can be counted

StepsTaken::Part whole(double from, double to, double step) {
  const time::Interval interval(from, to, step);
  return {interval, 0, interval.steps()};
}

bool is_whole(const StepsTaken::Part& part, double from, double to, double step) {
  return from <= to && (to - from) / step < most_steps && part == whole(from, to, step);
}

// Of parts in a row: `count` of them, from number `first` on, lead from the time of that number to the next, and so on.
struct Regular {
  std::uint64_t first = 0, time = 0, count = 0;
};

Regular longest_regular(const std::vector<StepsTaken::Part>& parts, std::span<const double> times, double step) {
  Regular longest, now;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const double from = parts[i].interval.start(0);
    const auto at = static_cast<std::size_t>(std::lower_bound(times.begin(), times.end(), from) - times.begin());
    const bool fits = at + 1 < times.size() && times[at] == from && is_whole(parts[i], from, times[at + 1], step);
    if (!fits) {
      now.count = 0;
      continue;
    }
    if (now.count == 0 || now.time + now.count != at) now = {i, at, 0};
    if (++now.count > longest.count) longest = now;
  }
  return longest;
}

}  // namespace

void StepsTaken::add(const time::Interval& interval, std::size_t i) {
  if (i == 0 || parts_.empty()) parts_.push_back({interval, i, 0});
  ++parts_.back().steps;
}

void StepsTaken::pass(base::StateBytes& bytes, std::span<const double> times, double step) {
  Regular regular = bytes.reading() ? Regular() : longest_regular(parts_, times, step);
  const auto begin = parts_.begin() + static_cast<std::ptrdiff_t>(regular.first);
  std::vector<Part> before(parts_.begin(), begin);
  std::vector<Part> after(begin + static_cast<std::ptrdiff_t>(regular.count), parts_.end());
  bytes(before, regular.time, regular.count, after);
  if (!bytes.reading()) return;
  if (regular.count > 0 && (regular.time >= times.size() || regular.count > times.size() - 1 - regular.time))
    throw std::out_of_range("it has steps to outputs that it does not have");
  parts_ = std::move(before);
  for (std::uint64_t k = regular.time; k < regular.time + regular.count; ++k) {
    if (!(times[k] <= times[k + 1] && (times[k + 1] - times[k]) / step < most_steps))
      throw std::out_of_range("its times are wrong");
    parts_.push_back(whole(times[k], times[k + 1], step));
  }
  parts_.insert(parts_.end(), after.begin(), after.end());
}

bool StepsTaken::fit(double step, double now) const {
  double reached = 0;
  for (const Part& part : parts_) {
    const std::size_t steps = part.interval.steps();
    const double begin = part.interval.start(0), end = part.interval.start(steps);
    if (!(begin >= 0 && (end - begin) / step < most_steps) || part.interval != time::Interval(begin, end, step))
      return false;
    if (part.first > steps || part.steps > steps - part.first || !(part.interval.start(part.first) >= reached))
      return false;
    reached = part.interval.start(part.first + part.steps);
  }
  return reached <= now;
}

}  // namespace gaussdrift
