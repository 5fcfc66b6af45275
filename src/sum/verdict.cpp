#include "sum/verdict.hpp"

#include <fmt/format.h>

#include <cmath>

#include "base/duration_text.hpp"
#include "gaussdrift/error.hpp"

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

void tell_or_refuse(const PointsRequest& request, const PredictedWork& work,
                    const std::function<PredictedWork()>& fastest) {
  const int threads = base::resolve_threads(request.threads);
  const std::string by =
      fmt::format("about {} on {} {}", base::duration_text(work.seconds), threads, threads == 1 ? "thread" : "threads");
  if (work.seconds <= request.most_seconds) {
    if (request.tell) request.tell(fmt::format("{} takes {}", work.method, by));
    if (request.predicted) request.predicted(work.seconds);
    return;
  }
  const PredictedWork other = fastest();
  const bool faster = !other.method.empty() && other.seconds < work.seconds / 2;
  throw InputError(fmt::format("{} would take {}, and only sums of up to {} are begun. {}, or raise --seconds.",
                               work.method, by, base::duration_text(request.most_seconds),
                               faster ? fmt::format("Use --method auto, which takes about {} ({})",
                                                    base::duration_text(other.seconds), other.method)
                                      : "Ask for fewer targets or a larger tolerance"));
}

}  // namespace gaussdrift::sum
