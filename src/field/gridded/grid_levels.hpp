// The numbers of a grid at many times, of which only some are held: those that were asked for last.
#pragma once

#include <cstddef>
#include <functional>
#include <list>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace gaussdrift {

/// Safe to be called from several threads.
class GridLevels {
 public:
  using Values = std::shared_ptr<const std::vector<double>>;
  /// Reads the numbers of a time. Is called by one thread at a time.
  using Load = std::function<std::vector<double>(std::size_t time)>;

  /// `most_held`: how many times are held, at least 1.
  GridLevels(std::size_t most_held, Load load) : most_held_(most_held), load_(std::move(load)) {}

  /// Throws what loading throws.
  Values at(std::size_t time) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    for (auto level = held_.begin(); level != held_.end(); ++level)
      if (level->first == time) {
        held_.splice(held_.begin(), held_, level);
        return held_.front().second;
      }
    while (held_.size() >= most_held_) held_.pop_back();  // before there is another
    held_.emplace_front(time, std::make_shared<const std::vector<double>>(load_(time)));
    return held_.front().second;
  }

  std::size_t most_held() const { return most_held_; }

  /// Others that hold what `change` makes of the numbers. They are read anew.
  template <class Change>
  std::shared_ptr<const GridLevels> changed(const Change& change) const {
    return std::make_shared<const GridLevels>(most_held_,
                                              [load = load_, change](std::size_t time) { return change(load(time)); });
  }

 private:
  std::size_t most_held_;
  Load load_;
  mutable std::mutex mutex_;
  mutable std::list<std::pair<std::size_t, Values>> held_;  // the one that was asked for last comes first
};

}  // namespace gaussdrift
