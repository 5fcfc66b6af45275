// Processor seconds of this thread. Trials run on one thread and are timed by it: other programs on the machine, and
// threads that wait for each other in a small trial, do not count.
#pragma once

#include <ctime>

namespace gaussdrift::accuracy {

class ProcessorClock {
 public:
  double seconds() const { return now() - start_; }

 private:
  static double now() {
    timespec time{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
  }
  double start_ = now();
};

}  // namespace gaussdrift::accuracy
