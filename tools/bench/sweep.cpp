// How good is Method::automatic? Over a random sweep (sweep_points.hpp) it is timed beside every method; the program
// reports in what share of the points it takes at most 1.5 times the best, lists the worst, and how far the prediction
// of each method is from what was measured.
//
//   sweep [points = 200] [seconds a run may be predicted to take = 2]
#include <cstdio>
#include <cstdlib>
#include <map>

#include "sweep_points.hpp"

namespace {

struct Result {
  bench::SweepPoint point;
  bench::Timing automatic, best;
  fgtd::Method method{};  // the best
  double ratio() const { return automatic.seconds / best.seconds; }
};

/// Measured over predicted.
struct Prediction {
  int count = 0;
  double sum = 0, squares = 0;  // of logarithms
  void add(double ratio) {
    ++count;
    sum += std::log(ratio);
    squares += std::log(ratio) * std::log(ratio);
  }
};

}  // namespace

int main(int argc, char** argv) {
  const int count = argc > 1 ? std::atoi(argv[1]) : 200;
  const double limit = argc > 2 ? std::atof(argv[2]) : 2;
  std::vector<Result> results;
  std::map<fgtd::Method, Prediction> predictions;
  int refused = 0;
  for (const bench::SweepPoint& point : bench::sweep_points(count)) {
    bench::with_task(point, [&](const auto& task) {
      try {
        task.time(fgtd::Method::automatic, limit);  // the first run meets cold memory and tables
        Result result{point, task.time(fgtd::Method::automatic, limit), {}, {}};
        if (!result.automatic.done) return;
        for (const fgtd::Method method : fgtd::methods()) {
          if (method == fgtd::Method::automatic) continue;
          // a method that predicts 30 times the time of the choice is believed
          const bench::Timing timing =
              task.time(method, std::min(limit, std::max(1e-4, 30 * result.automatic.choice.seconds)));
          if (!timing.done || timing.choice.method != method) continue;
          predictions[method].add(timing.seconds / timing.choice.seconds);
          if (result.best.done && timing.seconds >= result.best.seconds) continue;
          result.best = timing;
          result.method = method;
        }
        if (!result.best.done) return;
        // once more, so that a change in the machine's speed meanwhile is not taken for a bad choice
        const bench::Timing again = task.time(fgtd::Method::automatic, limit);
        if (again.seconds < result.automatic.seconds) result.automatic = again;
        results.push_back(result);
      } catch (const fgtd::Error& error) {
        std::printf("%s: %s\n", point.text().c_str(), error.what());
        ++refused;
      }
    });
  }
  std::sort(results.begin(), results.end(), [](const Result& a, const Result& b) { return a.ratio() > b.ratio(); });
  const auto good = std::count_if(results.begin(), results.end(), [](const Result& r) { return r.ratio() <= 1.5; });
  std::printf("%zu points, automatic within 1.5 times the best in %.1f %%; %d refused\n", results.size(),
              results.empty() ? 0.0 : 100.0 * static_cast<double>(good) / static_cast<double>(results.size()), refused);
  std::printf("measured over predicted time, geometric mean and spread:\n");
  for (const auto& [method, prediction] : predictions) {
    const double mean = prediction.sum / prediction.count;
    std::printf("  %-10s %5d points  %6.2f  times or divided by %.2f\n", fgtd::to_string(method).c_str(),
                prediction.count, std::exp(mean),
                std::exp(std::sqrt(std::max(0.0, prediction.squares / prediction.count - mean * mean))));
  }
  std::printf("worst points:\n");
  for (std::size_t i = 0; i < std::min<std::size_t>(25, results.size()); ++i) {
    const Result& r = results[i];
    std::printf("  %5.2f  %s: %s %.3g ms (predicted %.3g), best %s %.3g ms (predicted %.3g)\n", r.ratio(),
                r.point.text().c_str(), fgtd::to_string(r.automatic.choice.method).c_str(), 1e3 * r.automatic.seconds,
                1e3 * r.automatic.choice.seconds, fgtd::to_string(r.method).c_str(), 1e3 * r.best.seconds,
                1e3 * r.best.choice.seconds);
  }
  return 0;
}
