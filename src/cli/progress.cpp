#include "cli/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace gaussdrift::cli {

namespace {

constexpr double terminal_interval = 0.1;  // seconds between two lines
constexpr double plain_interval = 10;      // the same where lines pile up (files, pipes)

std::string duration(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

}  // namespace

std::string progress_text(const Progress& progress) {
  double fraction = progress.end > 0 ? progress.time / progress.end : 1;
  std::string steps = fmt::format("{}", progress.steps_done);
  if (progress.steps_total > 0) {
    fraction = static_cast<double>(progress.steps_done) / static_cast<double>(progress.steps_total);
    steps += fmt::format(" of {}", progress.steps_total);
  }
  const double per_step =
      progress.steps_done > 0 ? 1e3 * progress.step_seconds / static_cast<double>(progress.steps_done) : 0;
  // Frames come evenly enough that the whole time so far, not only the steps, tells what is left.
  const double left = fraction > 0 ? progress.seconds * (1 - fraction) / fraction : 0;
  return fmt::format("{:3.0f} %  t = {:.4g} of {:.4g}  step {}  {:.3g} ms a step  {} left", std::floor(100 * fraction),
                     progress.time, progress.end, steps, per_step, duration(left));
}

ProgressLine::ProgressLine() : terminal_(isatty(STDERR_FILENO) != 0 && std::getenv("NO_COLOR") == nullptr) {}

void ProgressLine::show(const Progress& progress) { show(progress_text(progress)); }

void ProgressLine::show(const std::string& text) {
  const double now = watch_.seconds();
  if (!terminal_ && last_ < 0) last_ = 0;  // short runs leave no progress lines in a file
  if (last_ >= 0 && now - last_ < (terminal_ ? terminal_interval : plain_interval)) return;
  last_ = now;
  if (terminal_) {
    std::fprintf(stderr, "\r\033[K%s", text.c_str());
    visible_ = true;
  } else {
    std::fprintf(stderr, "%s\n", text.c_str());
  }
  std::fflush(stderr);
}

void ProgressLine::clear() {
  if (visible_) std::fputs("\r\033[K", stderr);
  visible_ = false;
}

}  // namespace gaussdrift::cli
