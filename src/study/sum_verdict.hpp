// What a sum is judged by: errors measured against all pairs at some targets, and the seconds that are predicted.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "study/points_request.hpp"

namespace gaussdrift::study {

/// An error in the measure that the tolerance is promised in.
struct MeasuredError {
  std::string of;      // "the field"
  double error = 0;    // largest at the compared targets
  double allowed = 0;  // tolerance and rounding
};

/// Sentences about errors beyond what is allowed; what is not a number is beyond.
std::vector<std::string> broken_promises(const std::vector<MeasuredError>& errors, std::size_t targets);

/// "45 s", "12 minutes", "3.5 hours", "12 days".
std::string duration_text(double seconds);

/// Work of so many predicted seconds, by what: told from some seconds on, and refused (InputError) beyond
/// request.most_seconds. `fastest` says how long `auto` would take, and by what; empty if nothing is faster.
struct PredictedWork {
  double seconds = 0;  // of the clock
  std::string method;
};
void tell_or_refuse(const PointsRequest& request, const PredictedWork& work,
                    const std::function<PredictedWork()>& fastest);

/// Calls work(most seconds on one thread), and again without a limit where the limit was no reason to refuse.
/// Limit is the exception of the library; fastest(0) is work by `auto`, which the limit 0 stops.
template <class Limit, class Work, class Fastest>
void within_seconds(const PointsRequest& request, const Work& work, const Fastest& fastest) {
  constexpr double told_from = 5;
  const double threads = base::resolve_threads(request.threads);
  const auto predicted = [&](const Limit& limit) {
    return PredictedWork{limit.seconds / threads, to_string(limit.method)};
  };
  try {
    return work(std::min(told_from, request.most_seconds) * threads);
  } catch (const Limit& limit) {
    tell_or_refuse(request, predicted(limit), [&]() -> PredictedWork {
      try {
        fastest(0.0);
      } catch (const Limit& other) {
        return predicted(other);
      }
      return {};
    });
  }
  work(std::numeric_limits<double>::infinity());
}

}  // namespace gaussdrift::study
