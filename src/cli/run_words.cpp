#include "cli/run_words.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "base/counted.hpp"
#include "base/stopwatch.hpp"
#include "effect/catalogue.hpp"
#include "sim/checks.hpp"
#include "write/output_files.hpp"
#include "write/series_table.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// "smoothing 0.024 dominates, quadrature 4e-07, ..."
std::string one_line(const accuracy::Budget& budget) {
  std::vector<std::pair<double, std::string>> causes = accuracy::told_causes(budget);
  std::stable_sort(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [value, name] : causes)
    text += fmt::format("{}{} {:.1e}{}", text.empty() ? "" : ", ", name, value,
                        name == budget.dominates ? " dominates" : "");
  if (budget.interpolation > 0) text += fmt::format("; interpolation of the data {:.1e}", budget.interpolation);
  return text;
}

/// The stages that took the seconds, the largest first, down to a hundredth of all, and what no stage took: "charge
/// 460.21, density 30.02, other 5.31".
std::string seconds_text(const RunSummary& summary) {
  StageTimes parts;
  double told = 0;
  for (const auto& [stage, seconds] : summary.stages.stages()) {
    const std::string name = stage.starts_with("write ")          ? "files"
                             : stage.starts_with("effect ")       ? stage.substr(7)
                             : stage == "predicted error budget"  ? "error budget"
                             : stage == "measure transform error" ? "check of the transform"
                             : stage == "seed"                    ? "seeding"
                                                                  : stage;
    parts.add(name, seconds);
    told += seconds;
  }
  std::vector<std::pair<std::string, double>> rows = parts.stages();
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  if (summary.seconds > told) rows.emplace_back("other", summary.seconds - told);
  std::string text;
  for (const auto& [name, seconds] : rows)
    if (text.empty() || seconds >= 0.01 * summary.seconds)
      text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", name, seconds);
  return text;
}

std::string left_out_text(const Case& spec, const SeedReport& seeding) {
  std::string parts = fmt::format("{:.1e} of the mass", seeding.carried.front().part());
  if (const std::string_view besides = carried_besides(spec.effects); !besides.empty())
    parts += fmt::format(", {:.1e} of the {}", seeding.carried.back().part(), besides);
  return fmt::format("left out {} lattice points with less than {:g} of the largest weight: {} (particles.threshold)\n",
                     seeding.left_out, spec.particles.threshold, parts);
}

std::string extremes_text(const FrameNumbers& numbers) {
  return numbers.minimum < 0 ? fmt::format("rho in [{:.6g}, {:.6g}]", numbers.minimum, numbers.maximum)
                             : fmt::format("max rho = {:.6g}", numbers.maximum);
}

/// "72, 2020-01-06 00:00"
std::string time_text(const Case& spec, double t) {
  return fmt::format("{:.4g}{}", t, spec.time.date ? ", " + spec.time.date(t) : "");
}

/// What was done, and what came out.
std::string result_text(const Case& spec, const RunSummary& summary) {
  std::string text =
      fmt::format("{} {}, {}, {} in {:.2f} s on {} ({})\n", summary.complete ? "done  " : "so far",
                  base::counted(summary.particles, "particle"), base::counted(summary.steps, "step"),
                  base::counted(summary.frames.size(), "frame"), summary.seconds,
                  base::counted(static_cast<std::size_t>(summary.threads), "thread"), seconds_text(summary));
  if (!summary.frames.empty()) {
    double worst = 0;
    for (const auto& [time, numbers] : summary.frames) worst = std::max(worst, numbers.transform_error);
    const auto& [t0, first] = summary.frames.front();
    const auto& [t1, last] = summary.frames.back();
    std::string heights = fmt::format("{} at t = {}", extremes_text(first), time_text(spec, t0));
    if (summary.frames.size() > 1) heights += fmt::format(", {} at t = {}", extremes_text(last), time_text(spec, t1));
    const std::string derivatives = summary.derivatives_achievable > 0
                                        ? fmt::format(", derivatives to {:.0e} of theirs", summary.derivatives_error)
                                        : "";
    text += fmt::format("result {}; mass {:.9g}; Gauss transform right to {:.0e} of max rho{} ({})\n", heights,
                        last.mass, worst, derivatives,
                        spec.evaluate.hermite ? fmt::format("bound of r, p and n: {:.0e}", summary.transform_achievable)
                                              : fmt::format("{:.0e} asked", spec.evaluate.tolerance));
  }
  if (summary.seeding.left_out > 0) text += left_out_text(spec, summary.seeding);
  return text;
}

/// The error at the end, at its worst, and against the target.
std::string error_text(const RunSummary& summary, std::optional<double> target) {
  if (summary.frames.empty()) return "";
  const auto& [end, last] = summary.frames.back();
  const auto norms_text = [](const ErrorNorms& norms) {
    return fmt::format("L1 {:.2e}, L2 {:.2e}, Linf {:.2e}", norms.l1, norms.l2, norms.linf);
  };
  std::string text;
  if (!last.no_norms.empty()) {
    text += fmt::format("error  at t = {:.4g} {}\n", end, last.no_norms);
  } else if (last.error) {
    const std::string where = last.compared < summary.grid_points
                                  ? fmt::format(", on {} of {} grid points", last.compared, summary.grid_points)
                                  : "";
    const std::string how = summary.reference_word.empty() ? "" : ", " + summary.reference_word;
    text += fmt::format("error  at t = {:.4g}, relative to the exact density{}{}: {}\n", end, where, how,
                        norms_text(*last.error));
  }
  if (const auto* hardest = worst_output(summary.frames); hardest && hardest->first != end) {
    const std::string worst = norms_text(*hardest->second.error);
    if (!last.error || worst != norms_text(*last.error))
      text += fmt::format("worst  at t = {:.4g}: {}\n", hardest->first, worst);
  }
  if (target && !last.no_norms.empty())
    text += fmt::format("target {:g}: not known whether it is met, {}\n", *target, last.no_norms);
  else if (target && last.error)
    text += fmt::format("target {:g}: achieved {:.2e}{}\n", *target, last.error->linf,
                        last.error->linf <= *target ? "" : ", MISSED");
  return text;
}

std::string budget_text(const accuracy::Budget& budget) {
  if (!budget.known()) return fmt::format("budget none: {}\n", budget.not_covered);
  std::string text = fmt::format("budget {}\n", one_line(budget));
  for (const std::string& advice : budget.advice) text += fmt::format("hint   {}\n", advice);
  return text;
}

/// Where to look.
std::string files_text(const fs::path& folder) {
  const fs::path page = folder / "report.html", pictures = folder / "images",
                 density = folder / fmt::format("{}.pvd", write::density_output().about.name);
  return fmt::format("open   {}{}{}\n", fs::is_regular_file(page) ? page.string() + ", " : "",
                     fs::exists(density) ? density.string() + " in ParaView" : (folder / write::series_name).string(),
                     fs::exists(pictures) ? ", pictures in " + pictures.string() : "");
}

}  // namespace

std::string ending_text(const Case& spec, const RunSummary& summary, const std::optional<accuracy::Budget>& budget,
                        std::optional<double> target, const fs::path& folder) {
  std::string text = result_text(spec, summary) + error_text(summary, target);
  if (budget) text += budget_text(*budget);
  for (const CheckResult& result : summary.checks)  // of a run that was stopped they do not count yet
    if (summary.complete) text += fmt::format("check  {}: {}\n", result.passed ? "passed" : "FAILED", result.text);
  return text + files_text(folder);
}

}  // namespace gaussdrift::cli
