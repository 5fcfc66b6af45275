// Wall time, and seconds by stage.
#pragma once

#include <chrono>
#include <string>
#include <utility>
#include <vector>

namespace gaussdrift::base {

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Seconds by named stage, in the order in which the stages first ran.
class StageTimes {
 public:
  void add(const std::string& stage, double seconds) {
    for (auto& [name, total] : stages_)
      if (name == stage) {
        total += seconds;
        return;
      }
    stages_.emplace_back(stage, seconds);
  }
  /// Runs `work` and books its time.
  template <class Work>
  void run(const std::string& stage, const Work& work) {
    const Stopwatch watch;
    work();
    add(stage, watch.seconds());
  }
  const std::vector<std::pair<std::string, double>>& stages() const { return stages_; }

 private:
  std::vector<std::pair<std::string, double>> stages_;
};

}  // namespace gaussdrift::base
