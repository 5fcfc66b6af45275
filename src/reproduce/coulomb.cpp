#include "reproduce/coulomb.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <random>

#include "base/stopwatch.hpp"
#include "reproduce/published.hpp"

namespace gaussdrift::reproduce {

namespace {

// Tolerances at which the error of unit charges in a cube is below the published ones (docs/farfield.md, "The
// promise").
constexpr double for_tree = 3e-3, for_symmetric = 3e-4;
constexpr Eigen::Index compared = 500;

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
  time.setup = watch.seconds();
  farfield::Values<3> values = plan.evaluate(charges, &time.parts);
  time.seconds = watch.seconds();
  time.work = plan.choice().work;
  return std::move(values.field);
}

}  // namespace

CoulombReproduction reproduce_coulomb(const CoulombOptions& options, const std::function<void(std::size_t)>& progress) {
  const base::Stopwatch watch;
  CoulombReproduction result;
  result.threads = options.threads;
  using farfield::Method;
  const PublishedTable published("boerm-coulomb");
  for (std::size_t i = 0; i < published.rows(); ++i) {
    const auto particles = static_cast<std::size_t>(*published.number(i, "particles"));
    if (particles > options.most_particles) break;
    if (progress) progress(particles);
    CoulombRow ours;
    ours.particles = particles;
    ours.direct.published_seconds = published.number(i, "seconds_direct");
    ours.tree.published_seconds = published.number(i, "seconds_tree");
    ours.tree.published_forward = published.number(i, "forward_tree");
    ours.tree.published_coupling = published.number(i, "coupling_tree");
    ours.tree.published_error = published.number(i, "error_tree");
    ours.symmetric.published_seconds = published.number(i, "seconds_symmetric");
    ours.symmetric.published_error = published.number(i, "error_symmetric");
    const farfield::Points<3> points = cube(particles), targets = some_of(points);
    const Eigen::VectorXd charges = Eigen::VectorXd::Ones(points.cols());
    const farfield::Plan<3> pairs(farfield::Kernel::coulomb, points, targets, {.method = Method::direct});
    const farfield::Points<3> exact = pairs.evaluate(charges).field;
    if (particles <= options.most_by_pairs)
      timed_field(points, charges, {.method = Method::direct, .threads = options.threads}, ours.direct);
    for (const auto& [method, tolerance, time] : {std::tuple{Method::tree, for_tree, &ours.tree},
                                                  std::tuple{Method::symmetric, for_symmetric, &ours.symmetric}}) {
      const farfield::Points<3> field =
          timed_field(points, charges, {.tolerance = tolerance, .method = method, .threads = options.threads}, *time);
      time->error = (some_of(field) - exact).norm() / exact.norm();
      if (time->published_error && *time->error > *time->published_error)
        result.disagreements.push_back(fmt::format("{} particles, {}: error {:.1e}, published {:.1e}", particles,
                                                   farfield::to_string(method), *time->error, *time->published_error));
    }
    result.rows.push_back(ours);
  }
  // Three doublings put as many points into the leaves as before; in between, how full they are goes up and down.
  for (const CoulombRow& few : result.rows) {
    const CoulombRow& many = result.rows.back();
    if (8 * few.particles != many.particles) continue;
    const auto exponent = [](double before, double after) { return std::log(after / before) / std::log(8.0); };
    result.growth = {exponent(*few.symmetric.seconds, *many.symmetric.seconds),
                     exponent(few.symmetric.work.pairs, many.symmetric.work.pairs),
                     exponent(few.symmetric.work.couplings, many.symmetric.work.couplings)};
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
      "Boerm 2022, fast methods for many-particle systems: published numbers (pub.), and those computed on {} {}\n"
      "Errors are relative to the forces and must be at most the published ones. Seconds are of another machine and "
      "not "
      "compared.\n",
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
  // The slides split the seconds of tree in two; what they call coupling is everything after the forward
  // transformation.
  text += fmt::format("\nseconds by part\n{:>9} |{:^46} |{:^45} | {:^23}\n", "", "tree", "symmetric",
                      "symmetric, a particle");
  text += fmt::format("{:>9} |{:>7} {:>8}{:>8} {:>10}{:>11} |{:>9}{:>9}{:>9}{:>9}{:>9} | {:>10} {:>12}\n", "particles",
                      "setup", "pub.", "forward", "pub.", "coupling", "setup", "forward", "coupling", "backward",
                      "pairs", "pairs", "couplings");
  for (const CoulombRow& row : result.rows) {
    const auto particles = static_cast<double>(row.particles);
    const auto shown = [](const std::optional<double>& value) { return value ? fmt::format("{:.2f}", *value) : "-"; };
    text += fmt::format(
        "{:9} |{:7.3f} {:>8}{:8.3f} {:>10}{:11.3f} |{:9.3f}{:9.3f}{:9.3f}{:9.3f}{:9.3f} | {:10.0f} {:12.2f}\n",
        row.particles, row.tree.setup, shown(row.tree.published_forward), row.tree.parts.forward,
        shown(row.tree.published_coupling), row.tree.parts.leaves, row.symmetric.setup, row.symmetric.parts.forward,
        row.symmetric.parts.coupling, row.symmetric.parts.backward, row.symmetric.parts.leaves,
        row.symmetric.work.pairs / particles, row.symmetric.work.couplings / particles);
  }
  if (result.growth)
    text += fmt::format(
        "\nsymmetric, over the last three doublings of N: seconds grow like N^{:.2f}, pairs like N^{:.2f}, couplings "
        "like "
        "N^{:.2f}; N^1 is linear\n",
        result.growth->seconds, result.growth->pairs, result.growth->couplings);
  for (const std::string& line : result.disagreements) text += "disagrees: " + line + "\n";
  text += fmt::format("{}; {:.1f} s\n",
                      result.disagreements.empty() ? "all errors are at most the published ones"
                                                   : "not all errors are at most the published ones",
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
            {"published_forward", number(time.published_forward)},
            {"published_coupling", number(time.published_coupling)},
            {"seconds", number(time.seconds)},
            {"error", number(time.error)},
            {"setup", time.setup},
            {"forward", time.parts.forward},
            {"coupling", time.parts.coupling},
            {"backward", time.parts.backward},
            {"leaves", time.parts.leaves},
            {"pairs", time.work.pairs},
            {"substitute_pairs", time.work.substitute_pairs},
            {"couplings", time.work.couplings}};
  };
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();
  for (const CoulombRow& row : result.rows)
    rows.push_back({{"particles", row.particles},
                    {"direct", of(row.direct)},
                    {"tree", of(row.tree)},
                    {"symmetric", of(row.symmetric)}});
  nlohmann::ordered_json growth = nullptr;
  if (result.growth)
    growth = {
        {"seconds", result.growth->seconds}, {"pairs", result.growth->pairs}, {"couplings", result.growth->couplings}};
  const nlohmann::ordered_json document{{"source", "Boerm 2022, fast methods for many-particle systems"},
                                        {"rows", rows},
                                        {"growth", growth},
                                        {"threads", result.threads},
                                        {"disagreements", result.disagreements},
                                        {"seconds", result.seconds}};
  return document.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) + "\n";
}

}  // namespace gaussdrift::reproduce
