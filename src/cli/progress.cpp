#include "cli/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "cli/terminal.hpp"

namespace gaussdrift::cli {

namespace {

constexpr double terminal_interval = 0.1;  // seconds between two lines
constexpr double plain_interval = 10;      // the same where lines pile up (files, pipes)
constexpr std::size_t least_columns = 40;  // a narrower terminal does not show enough of a line

std::string duration(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", seconds);
  if (seconds < 5400) return fmt::format("{:.0f} min", seconds / 60);
  return fmt::format("{:.1f} h", seconds / 3600);
}

std::string_view environment(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

/// Can a line be taken back? A wrapped one cannot, and not every terminal knows how.
bool rewrites_lines() {
  const std::string_view kind = environment("TERM");
  return environment("NO_COLOR").empty() && !kind.empty() && kind != "dumb" && columns_of(stderr) >= least_columns;
}

/// The beginning of a text that fits into this many columns, with whole UTF-8 characters.
std::string_view cut(std::string_view text, std::size_t most) {
  std::size_t shown = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    if ((static_cast<unsigned char>(text[i]) & 0xC0) != 0x80 && ++shown > most) return text.substr(0, i);
  return text;
}

double part_done(const Progress& progress) {
  if (progress.steps_total > 0)
    return static_cast<double>(progress.steps_done) / static_cast<double>(progress.steps_total);
  return progress.length > 0 ? progress.elapsed / progress.length : 1;
}

}  // namespace

std::optional<double> seconds_left(const Progress& progress) {
  const double fraction = part_done(progress);
  if (!(fraction > 0)) return std::nullopt;
  const double steps = progress.step_seconds * (1 - fraction) / fraction;
  const std::size_t outputs = progress.outputs_total - std::min(progress.outputs_done, progress.outputs_total);
  if (outputs == 0) return steps;
  if (progress.outputs_done == 0) return std::nullopt;
  return steps + (progress.seconds - progress.step_seconds) * static_cast<double>(outputs) /
                     static_cast<double>(progress.outputs_done);
}

std::string progress_text(const Progress& progress) {
  const double fraction = part_done(progress);
  const std::optional<double> left = seconds_left(progress);
  std::string steps = fmt::format("{}", progress.steps_done);
  if (progress.steps_total > 0) steps += fmt::format(" of {}", progress.steps_total);
  const double per_step =
      progress.steps_done > 0 ? 1e3 * progress.step_seconds / static_cast<double>(progress.steps_done) : 0;
  return fmt::format("{:3.0f} %  t = {:.4g} of {:.4g}  step {}  {:.3g} ms a step{}", std::floor(100 * fraction),
                     progress.time, progress.end, steps, per_step,
                     left ? fmt::format("  {} left", duration(*left)) : "");
}

ProgressLine::ProgressLine(double first) : terminal_(rewrites_lines()), first_(first) {}

void ProgressLine::show(const Progress& progress) { show(progress_text(progress)); }

void ProgressLine::show(const std::string& text) {
  const double now = watch_.seconds();
  if (now < first_) return;
  if (!terminal_ && last_ < 0) last_ = 0;  // short runs leave no progress lines in a file
  if (last_ >= 0 && now - last_ < (terminal_ ? terminal_interval : plain_interval)) return;
  last_ = now;
  terminal_ = terminal_ && rewrites_lines();  // a window may have been made narrow
  if (terminal_) {
    put(stderr, "\r\033[K");
    note("{}", cut(base::printable(text), columns_of(stderr) - 1));
    visible_ = true;
  } else {
    note("{}\n", text);
  }
}

void ProgressLine::clear() {
  if (visible_) put(stderr, "\r\033[K");
  visible_ = false;
}

}  // namespace gaussdrift::cli
