#include "study/reproduce_coulomb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/stopwatch.hpp"
#include "farfield/farfield.hpp"

namespace gaussdrift::study {

namespace {

struct Published {
  std::size_t particles;
  double direct, tree, tree_error, symmetric, symmetric_error;  // seconds; 0: not printed
};
constexpr Published published[] = {{25'000, 1.99, 0.42, 7.71e-6, 0.61, 5.64e-6},
                                   {50'000, 8.29, 1.04, 6.52e-6, 1.45, 5.84e-6},
                                   {100'000, 33.99, 2.49, 5.18e-6, 2.74, 6.67e-6},
                                   {200'000, 137.32, 5.86, 4.50e-6, 6.55, 6.40e-6},
                                   {400'000, 720.17, 14.63, 4.18e-6, 14.76, 6.34e-6},
                                   {800'000, 0, 45.73, 0, 26.43, 0},
                                   {1'600'000, 0, 121.93, 0, 61.32, 0},
                                   {3'200'000, 0, 272.01, 0, 134.28, 0},
                                   {6'400'000, 0, 676.81, 0, 235.21, 0}};

// Tolerances at which the error of unit charges in a cube is below the published ones (docs/farfield.md, "The
// promise").
constexpr double for_tree = 3e-3, for_symmetric = 3e-4;
constexpr Eigen::Index compared = 500;

std::optional<double> printed(double number) { return number > 0 ? std::optional<double>(number) : std::nullopt; }

farfield::Points<3> cube(std::size_t count) {
  std::mt19937_64 random(1);
  farfield::Points<3> points(3, static_cast<Eigen::Index>(count));
  for (double& x : points.reshaped()) x = static_cast<double>(random() >> 11) * 0x1p-53;
  return points;
}

farfield::Points<3> some_of(const farfield::Points<3>& points) {
  const Eigen::Index count = std::min(compared, points.cols());
  farfield::Points<3> some(3, count);
  for (Eigen::Index i = 0; i < count; ++i) some.col(i) = points.col(i * (points.cols() / count));
  return some;
}

farfield::Points<3> timed_field(const farfield::Points<3>& points, const Eigen::VectorXd& charges,
                                const farfield::Options& options, CoulombTime& time) {
  const base::Stopwatch watch;
  const farfield::Plan<3> plan(farfield::Kernel::coulomb, points, options);
  farfield::Values<3> values = plan.evaluate(charges);
  time.seconds = watch.seconds();
  return std::move(values.field);
}

}  // namespace

CoulombReproduction reproduce_coulomb(const CoulombOptions& options, const std::function<void(std::size_t)>& progress) {
  const base::Stopwatch watch;
  CoulombReproduction result;
  result.threads = options.threads;
  using farfield::Method;
  for (const Published& row : published) {
    if (row.particles > options.most_particles) break;
    if (progress) progress(row.particles);
    CoulombRow ours;
    ours.particles = row.particles;
    ours.direct.published_seconds = printed(row.direct);
    ours.tree.published_seconds = printed(row.tree);
    ours.tree.published_error = printed(row.tree_error);
    ours.symmetric.published_seconds = printed(row.symmetric);
    ours.symmetric.published_error = printed(row.symmetric_error);
    const farfield::Points<3> points = cube(row.particles), targets = some_of(points);
    const Eigen::VectorXd charges = Eigen::VectorXd::Ones(points.cols());
    const farfield::Plan<3> pairs(farfield::Kernel::coulomb, points, targets, {.method = Method::direct});
    const farfield::Points<3> exact = pairs.evaluate(charges).field;
    if (row.particles <= options.most_by_pairs)
      timed_field(points, charges, {.method = Method::direct, .threads = options.threads}, ours.direct);
    for (const auto& [method, tolerance, time] : {std::tuple{Method::tree, for_tree, &ours.tree},
                                                  std::tuple{Method::symmetric, for_symmetric, &ours.symmetric}}) {
      const farfield::Points<3> field =
          timed_field(points, charges, {.tolerance = tolerance, .method = method, .threads = options.threads}, *time);
      time->error = (some_of(field) - exact).norm() / exact.norm();
      if (time->published_error && *time->error > *time->published_error)
        result.disagreements.push_back(fmt::format("{} particles, {}: error {:.1e}, published {:.1e}", row.particles,
                                                   farfield::to_string(method), *time->error, *time->published_error));
    }
    result.rows.push_back(ours);
  }
  if (result.rows.size() > 1) {
    const CoulombRow &first = result.rows.front(), &last = result.rows.back();
    result.growth = std::log(*last.symmetric.seconds / *first.symmetric.seconds) /
                    std::log(static_cast<double>(last.particles) / static_cast<double>(first.particles));
  }
  result.seconds = watch.seconds();
  return result;
}

std::string to_text(const CoulombReproduction& result) {
  const auto seconds = [](const std::optional<double>& value) {
    return value ? fmt::format("{:9.2f}", *value) : fmt::format("{:>9}", "-");
  };
  const auto error = [](const std::optional<double>& value) {
    return value ? fmt::format("{:9.1e}", *value) : fmt::format("{:>9}", "-");
  };
  std::string text = fmt::format(
      "Boerm 2022, forces between many particles: published, and computed on {} {} (seconds; error relative "
      "to the forces)\n",
      result.threads, result.threads == 1 ? "thread" : "threads");
  text += fmt::format("{:>9} |{:^18} |{:^36} |{:^36} |\n", "", "all pairs", "tree", "symmetric");
  text += fmt::format("{:>9} |{:>9}{:>9} |{:>9}{:>9}{:>9}{:>9} |{:>9}{:>9}{:>9}{:>9} | {}\n", "particles", "pub. s",
                      "s", "pub. s", "s", "pub. err", "error", "pub. s", "s", "pub. err", "error", "us a particle");
  for (const CoulombRow& row : result.rows) {
    text +=
        fmt::format("{:9} |{}{} |", row.particles, seconds(row.direct.published_seconds), seconds(row.direct.seconds));
    for (const CoulombTime* time : {&row.tree, &row.symmetric})
      text += fmt::format("{}{}{}{} |", seconds(time->published_seconds), seconds(time->seconds),
                          error(time->published_error), error(time->error));
    text += fmt::format(" {:.2f}\n", *row.symmetric.seconds / static_cast<double>(row.particles) * 1e6);
  }
  if (result.growth)
    text += fmt::format("\nsymmetric: seconds grow like N^{:.2f} from the first to the last row; linear is N^1\n",
                        *result.growth);
  for (const std::string& line : result.disagreements) text += "disagrees: " + line + "\n";
  text += fmt::format("{} in {:.1f} s\n",
                      result.disagreements.empty() ? "all errors at most the published ones" : "not all as published",
                      result.seconds);
  return text;
}

std::string to_json(const CoulombReproduction& result) {
  const auto number = [](const std::optional<double>& value) -> nlohmann::ordered_json {
    if (value) return *value;
    return nullptr;
  };
  const auto of = [&](const CoulombTime& time) -> nlohmann::ordered_json {
    return {{"published_seconds", number(time.published_seconds)},
            {"published_error", number(time.published_error)},
            {"seconds", number(time.seconds)},
            {"error", number(time.error)}};
  };
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const CoulombRow& row : result.rows)
    rows.push_back({{"particles", row.particles},
                    {"direct", of(row.direct)},
                    {"tree", of(row.tree)},
                    {"symmetric", of(row.symmetric)}});
  const nlohmann::ordered_json document{{"source", "Boerm 2022, forces between many particles"},
                                        {"rows", rows},
                                        {"growth", number(result.growth)},
                                        {"threads", result.threads},
                                        {"disagreements", result.disagreements},
                                        {"seconds", result.seconds}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::study
