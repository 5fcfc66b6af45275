#include "cli/stop_request.hpp"

#include <fmt/format.h>

#include <array>
#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>

#include "base/duration_text.hpp"

namespace gaussdrift::cli {

namespace {

constexpr std::array signals{SIGINT, SIGTERM, SIGHUP};

volatile std::sig_atomic_t received = 0;
std::atomic<std::int64_t> received_at{0};                       // nanoseconds of the clock that never goes back
static_assert(std::atomic<std::int64_t>::is_always_lock_free);  // a handler may set nothing else

std::int64_t nanoseconds_now() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{1'000'000'000} * now.tv_sec + now.tv_nsec;
}

std::array<struct sigaction, signals.size()> before;

extern "C" void remember(int signal) {
  received_at = nanoseconds_now();
  received = signal;
  for (const int each : signals) std::signal(each, SIG_DFL);  // a second one ends the program
}

}  // namespace

StopRequest::StopRequest(double after_seconds) : after_(after_seconds) {
  received = 0;
  for (std::size_t i = 0; i < signals.size(); ++i) {
    sigaction(signals[i], nullptr, &before[i]);
    if (before[i].sa_handler == SIG_IGN) continue;
    struct sigaction action {};
    action.sa_handler = remember;
    action.sa_flags = SA_RESTART;
    sigaction(signals[i], &action, nullptr);
  }
}

StopRequest::~StopRequest() {
  for (std::size_t i = 0; i < signals.size(); ++i) sigaction(signals[i], &before[i], nullptr);
}

bool StopRequest::by_signal() const { return received != 0; }

double StopRequest::seconds_since_signal() const {
  return by_signal() ? 1e-9 * static_cast<double>(nanoseconds_now() - received_at) : 0;
}

bool StopRequest::made() const { return by_signal() || watch_.seconds() > after_; }

ExitCode StopRequest::code() const {
  switch (received) {
    case SIGINT:
      return ExitCode::interrupted;
    case SIGTERM:
      return ExitCode::terminated;
    case SIGHUP:
      return ExitCode::hung_up;
    default:
      return ExitCode::stopped;
  }
}

std::string reason_to_stop(ExitCode code) {
  switch (code) {
    case ExitCode::interrupted:
      return "interrupted";
    case ExitCode::terminated:
      return "terminated";
    case ExitCode::hung_up:
      return "its terminal was closed";
    default:
      return "--stop-after";
  }
}

void declare_stop_after(OptionList& options, std::string& value) {
  options.add("--stop-after", value, "TIME",
              "stop after this time (\"2 h\", \"90 min\", seconds), resumable; exit code 7");
}

double stop_after_seconds(const std::string& value) {
  if (value.empty()) return std::numeric_limits<double>::infinity();
  if (const auto seconds = base::read_duration(value)) return *seconds;
  throw CommandLineError(fmt::format("--stop-after {} is no length of time; give {}", value, base::duration_form));
}

}  // namespace gaussdrift::cli
