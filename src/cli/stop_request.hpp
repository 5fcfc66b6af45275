// Whether a run has been asked to stop: by a signal (Ctrl-C, a batch system, a closed terminal) or by the clock.
#pragma once

#include <limits>
#include <string>

#include "base/stopwatch.hpp"
#include "cli/options.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

/// While it lives, the first SIGINT, SIGTERM or SIGHUP is a request, and a second one ends the program at once. One that
/// was ignored before (nohup) stays ignored. There may be one at a time.
class StopRequest {
 public:
  explicit StopRequest(double after_seconds = std::numeric_limits<double>::infinity());
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

  bool made() const;
  /// By a signal: its sender does not wait for long.
  bool by_signal() const;
  /// Seconds since the signal; 0 where there was none.
  double seconds_since_signal() const;
  /// How the program then ends.
  ExitCode code() const;

 private:
  double after_;
  base::Stopwatch watch_;
};

/// "interrupted", "terminated", "its terminal was closed", "--stop-after": why a run ends with such a code.
std::string reason_to_stop(ExitCode code);

/// --stop-after, for verbs that run a case.
void declare_stop_after(OptionList& options, std::string& value);
/// What it was given, in seconds; infinity where it was not. Throws CommandLineError.
double stop_after_seconds(const std::string& value);

}  // namespace gaussdrift::cli
