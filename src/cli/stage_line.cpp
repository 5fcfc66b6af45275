#include "cli/stage_line.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <exception>
#include <system_error>

#include "base/duration_text.hpp"
#include "cli/terminal.hpp"

namespace gaussdrift::cli {

StageLine::StageLine() {
  if (columns_of(stderr) == 0) return;
  try {
    thread_ = std::thread([this] { tell(); });
  } catch (const std::system_error&) {  // where there are no more threads there is no line
  }
}

void StageLine::begin(const std::string& stage) {
  const std::lock_guard lock(mutex_);
  stage_ = stage;
  expected_ = 0;
  watch_ = base::Stopwatch();
}

void StageLine::expect(double seconds) {
  const std::lock_guard lock(mutex_);
  expected_ = seconds;
}

void StageLine::end() {
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
    line_.clear();
  }
  ended_.notify_all();
  if (thread_.joinable()) thread_.join();
}

void StageLine::tell() {
  constexpr auto interval = std::chrono::milliseconds(250);
  std::unique_lock lock(mutex_);
  while (!ended_.wait_for(lock, interval, [this] { return over_; })) {
    if (stage_.empty()) continue;
    try {
      line_.show(fmt::format("{}  {}{}", stage_, base::duration_text(watch_.seconds()),
                             expected_ > 0 ? " of about " + base::duration_text(expected_) : ""));
    } catch (const std::exception&) {  // no memory for a line
    }
  }
}

}  // namespace gaussdrift::cli
