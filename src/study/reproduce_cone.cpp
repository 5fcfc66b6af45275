#include "study/reproduce_cone.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/stopwatch.hpp"
#include "field/density.hpp"
#include "field/named_fields.hpp"
#include "particle/seeding.hpp"
#include "sim/density.hpp"
#include "sim/stepper.hpp"
#include "time/schedule.hpp"
#include "time/tableau.hpp"

namespace gaussdrift::study {

namespace {

// What the paper printed.

constexpr std::array<int, 6> lattices{100, 200, 300, 400, 500, 600};

// Table 5.1: overlap c, then the height at t = 0 for each lattice n_g.
struct Row51 {
  int overlap;
  std::array<double, 6> height;
};
constexpr std::array<Row51, 15> table_51{{
    {1, {0.946997, 0.985107, 0.993008, 0.995918, 0.997314, 0.998088}},
    {2, {0.831819, 0.947670, 0.974870, 0.985210, 0.990205, 0.992990}},
    {3, {0.698463, 0.894933, 0.947826, 0.968903, 0.979332, 0.985233}},
    {4, {0.572405, 0.833136, 0.914041, 0.947903, 0.965080, 0.974947}},
    {5, {0.464720, 0.767107, 0.875415, 0.923121, 0.947950, 0.962434}},
    {6, {0.377598, 0.700467, 0.833568, 0.895371, 0.928401, 0.947980}},
    {7, {0.308909, 0.635791, 0.789859, 0.865379, 0.906857, 0.931848}},
    {8, {0.255197, 0.574779, 0.745411, 0.833783, 0.883701, 0.914285}},
    {9, {0.213120, 0.518424, 0.701129, 0.801144, 0.859281, 0.895516}},
    {10, {0.179922, 0.467172, 0.657726, 0.767945, 0.833912, 0.875753}},
    {12, {0.132182, 0.379940, 0.575566, 0.701460, 0.781424, 0.833998}},
    {14, {0.100607, 0.311051, 0.501578, 0.636898, 0.728132, 0.790376}},
    {16, {0.078861, 0.257112, 0.436686, 0.575959, 0.675499, 0.746005}},
    {18, {0.063341, 0.214813, 0.380719, 0.519640, 0.624604, 0.701790}},
    {20, {0.051920, 0.181414, 0.332916, 0.468393, 0.576195, 0.658441}},
}};

// Table 5.2: overlap c, then the height at t = 0, 2 pi, 20 pi for n_g = 300.
struct Row52 {
  int overlap;
  std::array<double, 3> height;
};
constexpr std::array<Row52, 10> table_52{{
    {2, {0.974870, 0.974903, 0.975003}},
    {4, {0.914041, 0.914067, 0.914147}},
    {6, {0.833568, 0.833588, 0.833651}},
    {8, {0.745411, 0.745427, 0.745476}},
    {10, {0.657726, 0.657739, 0.657776}},
    {12, {0.575566, 0.575576, 0.575604}},
    {14, {0.501578, 0.501585, 0.501607}},
    {16, {0.436686, 0.436691, 0.436708}},
    {18, {0.380719, 0.380723, 0.380736}},
    {20, {0.332916, 0.332919, 0.332928}},
}};

constexpr int evaluation_points = 700;  // n_ge
constexpr double step = 0.001;          // tau
constexpr Vector low{-1, -1, 0}, high{1, 1, 0};

struct Cone {
  Lattice seeding;
  Particles particles;
};

Cone seed_cone(int per_axis, int threads) {
  const RadialDensity wendland(RadialDensity::Profile::wendland, 2, {0.5, 0, 0}, 0.25, 1);
  Cone cone;
  cone.seeding = make_lattice(2, low, high, per_axis);
  cone.particles = seed(
      cone.seeding, [&](const PointsView& x, double* values) { wendland.add(x, values); }, threads);
  return cone;
}

double height(const Cone& cone, int overlap, int threads) {
  static const Lattice grid = make_lattice(2, low, high, evaluation_points);
  DensityOptions options;
  options.tolerance = 1e-9;  // far below the printed digits
  options.threads = threads;
  options.measure = false;
  const Cutoff cutoff = make_cutoff("gauss2", 2, overlap * cone.seeding.spacing);
  const DensityGrid density = evaluate_density(cone.particles, cutoff, grid, options);
  return *std::max_element(density.rho.begin(), density.rho.end());
}

}  // namespace

ConeReproduction reproduce_cone(int threads, const std::function<void(std::size_t, std::size_t)>& progress) {
  const base::Stopwatch watch;
  ConeReproduction result;
  const std::size_t total = table_51.size() * lattices.size() + 3 * table_52.size();
  const auto add = [&](ConeHeight entry) {
    result.worst_difference = std::max(result.worst_difference, std::abs(entry.computed - entry.published));
    result.heights.push_back(std::move(entry));
    if (progress) progress(result.heights.size(), total);
  };

  for (std::size_t i = 0; i < lattices.size(); ++i) {
    const Cone cone = seed_cone(lattices[i], threads);
    for (const Row51& row : table_51)
      add({51, lattices[i], row.overlap, "0", row.height[i], height(cone, row.overlap, threads)});
  }

  // The paper takes floor(t / tau) full steps and stops short of t; the heights show it.
  Cone cone = seed_cone(300, threads);
  const auto rotation = make_named_field("rotation", {.dimension = 2});
  const Stepper stepper(*rotation, time::find_tableau("rk4"), threads);
  const std::array<double, 3> turns{0, 1, 10};
  const std::array<std::string, 3> names{"0", "2 pi", "20 pi"};
  std::size_t taken = 0;
  for (std::size_t i = 0; i < turns.size(); ++i) {
    const auto wanted = static_cast<std::size_t>(std::floor(turns[i] * 2 * std::numbers::pi / step));
    const time::Interval interval(static_cast<double>(taken) * step, static_cast<double>(wanted) * step, step);
    stepper.advance(cone.particles, interval, 0, interval.steps(), taken);
    taken = wanted;
    for (const Row52& row : table_52)
      add({52, 300, row.overlap, names[i], row.height[i], height(cone, row.overlap, threads)});
  }
  result.seconds = watch.seconds();
  return result;
}

std::string to_text(const ConeReproduction& result) {
  // A published number, and beside it the computed one in the units of its last digit.
  const auto find = [&](int table, int overlap, int per_axis, const std::string& time) -> const ConeHeight& {
    return *std::find_if(result.heights.begin(), result.heights.end(), [&](const ConeHeight& entry) {
      return entry.table == table && entry.overlap == overlap && entry.per_axis == per_axis && entry.time == time;
    });
  };
  const auto cell = [](const ConeHeight& entry) {
    return fmt::format("  {:.6f} {:.7f}", entry.published, entry.computed);
  };

  std::string text = "Schroeder 2006, Table 5.1: height of the cone at t = 0 (published, computed)\n   c";
  for (const int n : lattices) text += fmt::format("  {:>18}", fmt::format("n_g = {}", n));
  text += "\n";
  for (const Row51& row : table_51) {
    text += fmt::format("{:4}", row.overlap);
    for (const int n : lattices) text += cell(find(51, row.overlap, n, "0"));
    text += "\n";
  }
  text += "\nSchroeder 2006, Table 5.2: height of the cone at time t, n_g = 300 (published, computed)\n   c";
  for (const std::string time : {"0", "2 pi", "20 pi"}) text += fmt::format("  {:>18}", "t = " + time);
  text += "\n";
  for (const Row52& row : table_52) {
    text += fmt::format("{:4}", row.overlap);
    for (const std::string time : {"0", "2 pi", "20 pi"}) text += cell(find(52, row.overlap, 300, time));
    text += "\n";
  }
  text += fmt::format("\n{} heights, largest difference {:.1e} (agreement: at most {:.0e}), {:.1f} s\n",
                      result.heights.size(), result.worst_difference, cone_agreement, result.seconds);
  return text;
}

std::string to_json(const ConeReproduction& result) {
  nlohmann::ordered_json heights = nlohmann::ordered_json::array();
  for (const ConeHeight& entry : result.heights)
    heights.push_back({{"table", entry.table == 51 ? "5.1" : "5.2"},
                       {"n_g", entry.per_axis},
                       {"c", entry.overlap},
                       {"t", entry.time},
                       {"published", entry.published},
                       {"computed", entry.computed}});
  const nlohmann::ordered_json document{{"source", "Schroeder 2006, Tables 5.1 and 5.2"},
                                        {"heights", heights},
                                        {"worst_difference", result.worst_difference},
                                        {"agreement", cone_agreement},
                                        {"seconds", result.seconds}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::study
