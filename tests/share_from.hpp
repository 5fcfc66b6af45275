// The seconds of work from which on it is shared among threads, for a while.
#pragma once

#include "base/parallel.hpp"

class ShareFrom {
 public:
  explicit ShareFrom(double seconds) : before_(gaussdrift::base::share_from(seconds)) {}
  ~ShareFrom() { gaussdrift::base::share_from(before_); }
  ShareFrom(const ShareFrom&) = delete;
  ShareFrom& operator=(const ShareFrom&) = delete;

  static constexpr double usual = 1e-4;

 private:
  const double before_;
};

/// Whether some call of the work opens no region of threads. Where this thread is held up by others small work looks
/// long, so the best of many calls counts.
template <class Work>
bool stays_on_its_thread(const Work& work) {
  const ShareFrom usual(ShareFrom::usual);
  for (int i = 0; i < 50; ++i) {
    const std::size_t before = gaussdrift::base::regions_opened();
    work();
    if (gaussdrift::base::regions_opened() == before) return true;
  }
  return false;
}
