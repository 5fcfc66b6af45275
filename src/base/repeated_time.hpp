// Seconds of work that is done several times. What else a machine does only adds to them, so the fastest counts. A
// second one that comes near it shows that it is no accident.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

namespace gaussdrift::base {

class RepeatedTime {
 public:
  void add(double seconds) {
    ++count_;
    second_ = std::min(second_, std::max(fastest_, seconds));
    fastest_ = std::min(fastest_, seconds);
  }
  std::size_t count() const { return count_; }
  /// Infinite before the first.
  double fastest() const { return fastest_; }
  /// The two fastest differ by at most a fifth.
  bool repeatable() const { return count_ > 1 && second_ <= 1.2 * fastest_; }

 private:
  std::size_t count_ = 0;
  double fastest_ = std::numeric_limits<double>::infinity(), second_ = std::numeric_limits<double>::infinity();
};

/// When a time is good enough.
struct EnoughTimes {
  double long_enough;  // seconds of work that needs no second measurement
  std::size_t most;    // measurements after which a time may be longer than that of dearer work
};

/// Which times of ever dearer work are to be measured again: short ones without a second like them, and those more than
/// a fifth longer than a time of something dearer.
inline std::vector<std::size_t> to_measure_again(const std::vector<RepeatedTime>& times, const EnoughTimes& enough) {
  std::vector<std::size_t> again;
  double dearer = std::numeric_limits<double>::infinity();
  for (std::size_t i = times.size(); i-- > 0;) {
    const double fastest = times[i].fastest();
    const bool confirmed = times[i].repeatable() || (times[i].count() == 1 && fastest >= enough.long_enough);
    const bool in_order = fastest <= 1.2 * dearer || times[i].count() >= enough.most;
    if (!confirmed || !in_order) again.insert(again.begin(), i);
    dearer = std::min(dearer, fastest);
  }
  return again;
}

}  // namespace gaussdrift::base
