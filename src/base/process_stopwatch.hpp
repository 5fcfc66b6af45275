// Processor seconds of this process, all of its threads together. What it waits for does not count.
#pragma once

#include <ctime>

namespace gaussdrift::base {

class ProcessStopwatch {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double start_ = now();
};

}  // namespace gaussdrift::base
