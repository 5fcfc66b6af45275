#include "accuracy/accuracy_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <numeric>
#include <vector>

#include "base/repeated_time.hpp"
#include "sim/borders/edges.hpp"
#include "sim/scene.hpp"
#include "sim/tiled_density.hpp"
#include "sim/transform.hpp"

namespace gaussdrift::accuracy {

nlohmann::ordered_json accuracy_table(const Case& spec, double run_seconds, const LastFrame::Kept& last, int threads) {
  using json = nlohmann::ordered_json;
  if (!last.any || last.particles.size() == 0) return {{"accuracy_table_left_out", "no particles are left at the end"}};
  if (std::all_of(last.density.rho.begin(), last.density.rho.end(), [](double value) { return value == 0; }))
    return {{"accuracy_table_left_out", "the last output is 0 on the whole grid"}};
  constexpr std::array tolerances{1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12};
  constexpr std::size_t rows = tolerances.size(), most_rounds = 20;
  const double most = std::max(0.5, 0.1 * run_seconds), once = last.numbers.evaluate_seconds;
  if (once > most / rows)
    return {{"accuracy_table_left_out",
             fmt::format("a Gauss transform of this size takes {:.2g} s, and {} of them would be more than a tenth of "
                         "the run",
                         once, rows)}};
  const Scene scene = make_scene(spec, threads);
  const Cutoff blob = blob_of(scene, last.particles);
  Particles images;
  const Particles& sources = summed_particles(spec.domain, last.particles, reach_of_blob(blob, {}), images);
  const base::EnoughTimes enough{.long_enough = most / rows, .most = 6};
  std::vector<base::RepeatedTime> times(rows);
  std::array<double, rows> error{};
  double spent = 0;
  std::vector<std::size_t> open(rows);
  std::iota(open.begin(), open.end(), std::size_t{0});
  // All in turn, so that a moment when the machine is busy does not fall on one alone. Twice at least.
  for (std::size_t round = 0; round < most_rounds && !open.empty() && (round < 2 || spent < most); ++round) {
    for (const std::size_t i : open) {
      DensityReport report;
      evaluate_density(
          sources, blob, scene.evaluation,
          {.tolerance = tolerances[i], .method = spec.evaluate.method, .threads = threads, .measure = round == 0},
          &report);
      if (round == 0) error[i] = report.measured_error;
      times[i].add(report.evaluate_seconds);
      spent += report.evaluate_seconds;
    }
    open = base::to_measure_again(times, enough);
  }
  json table = json::array(), result = json::object();
  for (std::size_t i = 0; i < rows; ++i) {
    const bool doubtful = std::find(open.begin(), open.end(), i) != open.end();
    table.push_back({{"tolerance", tolerances[i]},
                     {"error", error[i]},
                     {"milliseconds", doubtful ? json(nullptr) : json(1e3 * times[i].fastest())}});
  }
  result["accuracy_table"] = table;
  if (!open.empty())
    result["accuracy_table_note"] =
        "The machine was busy with other work. A time is left out where measurements differ by more than a fifth, or "
        "where more digits took less time.";
  return result;
}

}  // namespace gaussdrift::accuracy
