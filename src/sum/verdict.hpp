// Judges a sum by its errors against all pairs at some targets, and by its predicted seconds.
#pragma once

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "base/parallel.hpp"
#include "sum/points_request.hpp"

namespace gaussdrift::sum {

/// An error in the measure that the tolerance is promised in.
struct MeasuredError {
  std::string of;      // "the field"
  double error = 0;    // largest at the compared targets
  double allowed = 0;  // tolerance and rounding
};

/// The largest of the errors at the compared targets. An error that is not a number stays.
class Worst {
 public:
  void take(double error) {
    if (!(error <= error_) && !std::isnan(error_)) error_ = error;
  }
  double error() const { return error_; }

 private:
  double error_ = 0;
};

/// An error in units of `size`. Without an error it is 0, even where `size` is 0.
inline double relative(double error, double size) { return error == 0 ? 0 : error / size; }

/// One sentence for each error beyond what is allowed; NaN is beyond.
std::vector<std::string> broken_promises(const std::vector<MeasuredError>& errors, std::size_t targets);

/// Tells the user of predicted work that takes some seconds or more, and refuses it (InputError) beyond
/// request.most_seconds. `fastest` gives the seconds and method of `auto`; empty if nothing is faster.
struct PredictedWork {
  double seconds = 0;  // of the clock
  std::string method;
};
void tell_or_refuse(const PointsRequest& request, const PredictedWork& work,
                    const std::function<PredictedWork()>& fastest);

/// Calls work(most seconds on one thread). If this limit stops it without being refused, calls it again without one.
/// Limit is the exception of the library; fastest(0) is work by `auto`, stopped by the limit 0.
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

}  // namespace gaussdrift::sum
