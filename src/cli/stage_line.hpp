// A line on a terminal that tells what a command is at and for how long, while it is at it: "summing  12 s of about 40 s".
// A thread of its own writes it, so the work need not know. Nothing is written elsewhere than on a terminal, nor by what
// takes less than two seconds.
#pragma once

#include <condition_variable>
#include <mutex>
#include <string>
#include <thread>

#include "base/stopwatch.hpp"
#include "cli/progress.hpp"

namespace gaussdrift::cli {

class StageLine {
 public:
  StageLine();
  ~StageLine() { end(); }
  StageLine(const StageLine&) = delete;
  StageLine& operator=(const StageLine&) = delete;

  /// What comes now: "reading S.csv".
  void begin(const std::string& stage);
  /// How many seconds that is thought to take.
  void expect(double seconds);
  /// Calls print() while there is no line.
  template <class Print>
  void aside(const Print& print) {
    const std::lock_guard lock(mutex_);
    line_.clear();
    print();
  }
  /// Takes the line back, for good.
  void end();

 private:
  void tell();

  std::mutex mutex_;
  std::condition_variable ended_;
  bool over_ = false;
  std::string stage_;
  double expected_ = 0;  // 0: not known
  base::Stopwatch watch_;
  ProgressLine line_{2};
  std::thread thread_;
};

}  // namespace gaussdrift::cli
