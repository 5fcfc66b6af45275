#include "sum/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/error.hpp"

namespace gaussdrift::sum {

std::vector<std::string> broken_promises(const std::vector<MeasuredError>& errors, std::size_t targets) {
  std::vector<std::string> sentences;
  for (const MeasuredError& measured : errors)
    if (!(measured.error <= measured.allowed))
      sentences.push_back(
          fmt::format("{} is wrong by {:.2g} where {:.2g} is promised. This was found at {} targets by summing all "
                      "pairs. Do not use these values. Use --method direct, which sums all pairs everywhere.",
                      measured.of, measured.error, measured.allowed, targets));
  return sentences;
}

std::string duration_text(double seconds) {
  if (seconds < 120) return fmt::format("{:.2g} s", seconds);
  if (seconds < 7200) return fmt::format("{:.0f} minutes", seconds / 60);
  if (seconds < 172800) return fmt::format("{:.2g} hours", seconds / 3600);
  return fmt::format("{:.3g} days", seconds / 86400);
}

void tell_or_refuse(const PointsRequest& request, const PredictedWork& work,
                    const std::function<PredictedWork()>& fastest) {
  const int threads = base::resolve_threads(request.threads);
  const std::string by =
      fmt::format("about {} on {} {}", duration_text(work.seconds), threads, threads == 1 ? "thread" : "threads");
  if (work.seconds <= request.most_seconds) {
    if (request.tell) request.tell(fmt::format("{} takes {}", work.method, by));
    return;
  }
  const PredictedWork other = fastest();
  const bool faster = !other.method.empty() && other.seconds < work.seconds / 2;
  throw InputError(fmt::format(
      "{} would take {}, and only sums of up to {} are begun. {}, or raise --seconds.", work.method, by,
      duration_text(request.most_seconds),
      faster ? fmt::format("Use --method auto, which takes about {} ({})", duration_text(other.seconds), other.method)
             : "Ask for fewer targets or a larger tolerance"));
}

}  // namespace gaussdrift::sum
