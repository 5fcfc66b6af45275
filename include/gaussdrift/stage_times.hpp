/// @file
/// Seconds by stage.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace gaussdrift {

/// Seconds by named stage, in the order in which the stages first ran.
class StageTimes {
 public:
  /// Adds to what the stage has taken so far.
  void add(const std::string& stage, double seconds) {
    for (auto& [name, total] : stages_)
      if (name == stage) {
        total += seconds;
        return;
      }
    stages_.emplace_back(stage, seconds);
  }
  /// Runs `work` and adds its wall time.
  template <class Work>
  void run(const std::string& stage, const Work& work) {
    const auto start = std::chrono::steady_clock::now();
    work();
    add(stage, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  /// Names and seconds.
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }
  /// Seconds of one stage; 0 if it never ran.
  double of(const std::string& stage) const {
    for (const auto& [name, total] : stages_)
      if (name == stage) return total;
    return 0;
  }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace gaussdrift
