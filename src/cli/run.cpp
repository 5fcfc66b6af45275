#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>

#include "accuracy/accuracy_table.hpp"
#include "accuracy/budget.hpp"
#include "accuracy/footprint.hpp"
#include "accuracy/forecast.hpp"
#include "accuracy/target.hpp"
#include "accuracy/would_run.hpp"
#include "base/parallel.hpp"
#include "base/printable.hpp"
#include "cli/owed_files.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "input/read_case.hpp"
#include "render/picture_series.hpp"
#include "report/page.hpp"
#include "reproduce/claims.hpp"
#include "reproduce/cone.hpp"
#include "reproduce/coulomb.hpp"
#include "reproduce/fgtd.hpp"
#include "reproduce/figures.hpp"
#include "reproduce/logkernel.hpp"
#include "sim/outside.hpp"
#include "sim/simulation.hpp"
#include "write/atomic_file.hpp"
#include "write/observers.hpp"
#include "write/provenance.hpp"
#include "write/run_folder.hpp"
#include "write/summary.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

Case read(const CaseOptions& options) {
  std::vector<std::string> overrides = options.overrides;
  if (!options.accuracy.empty()) overrides.push_back("accuracy.target=" + options.accuracy);
  input::ReadResult result = input::read_case(options.file, overrides, options.threads);
  for (const std::string& warning : result.warnings) note("{}\n", warning);
  return std::move(result.scene);
}

/// The case as it is, or with settings for its accuracy.target, which the user is told.
Case settled(Case scene, const CaseOptions& options) {
  if (!scene.accuracy.target) return scene;
  accuracy::AccuracyChoice choice;
  {
    ProgressLine line(1);
    choice = accuracy::choose_for_accuracy(scene, *scene.accuracy.target, options.threads,
                                           [&](const std::string& what) { line.show(what); });
  }
  put(options.json ? stderr : stdout, accuracy::to_text(choice));
  return std::move(choice.scene);
}

/// "smoothing 0.024 dominates, quadrature 4e-07, ..."
std::string one_line(const accuracy::Budget& budget) {
  std::vector<std::pair<double, std::string>> causes{{budget.time_stepping, "time stepping"},
                                                     {budget.smoothing, "smoothing"},
                                                     {budget.quadrature, "quadrature"},
                                                     {budget.transform, "Gauss transform"}};
  if (budget.left_out > 0) causes.emplace_back(budget.left_out, "particles left out");
  std::stable_sort(causes.begin(), causes.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text;
  for (const auto& [value, name] : causes)
    text += fmt::format("{}{} {:.1e}{}", text.empty() ? "" : ", ", name, value,
                        name == budget.dominates ? " dominates" : "");
  return text;
}

std::vector<render::Style> styles_of(const Case& scene) {
  std::vector<render::Style> styles;
  for (const OutputSpec::Image image : scene.output.images) {
    switch (image) {
      case OutputSpec::Image::surface:
        styles.push_back(render::Style::surface);
        break;
      case OutputSpec::Image::contour:
        styles.push_back(render::Style::contour);
        break;
      case OutputSpec::Image::heatmap:
        styles.push_back(render::Style::heatmap);
        break;
      case OutputSpec::Image::slices:
        styles.push_back(render::Style::slices);
        break;
      case OutputSpec::Image::projection:
        styles.push_back(render::Style::projection);
        break;
      case OutputSpec::Image::isosurface:
        styles.push_back(render::Style::isosurface);
        break;
      case OutputSpec::Image::error:
        styles.push_back(render::Style::error);
        break;
    }
  }
  return styles;
}

void add_observers(Simulation& simulation, const Case& scene, const fs::path& folder) {
  simulation.observe(
      write::series_table(folder, scene.domain.dimension, scene.reference.kind != ReferenceSpec::Kind::none));
  for (const OutputSpec::Vtk kind : scene.output.vtk)
    simulation.observe(kind == OutputSpec::Vtk::density ? write::density_files(folder) : write::particle_files(folder));
  if (const auto styles = styles_of(scene); !styles.empty()) {
    if (const std::string reason = render::unavailable_reason(); !reason.empty())
      note("warning: no pictures are drawn: {}\n", reason);
    else
      simulation.observe(render::picture_series(folder, styles, scene.title.empty() ? scene.name : scene.title));
  }
}

/// The stages that took the seconds, the largest first, down to a hundredth of all: "charge 460.21, density 30.02".
std::string seconds_text(const RunSummary& summary) {
  base::StageTimes parts;
  double told = 0;
  for (const auto& [stage, seconds] : summary.stages.stages()) {
    const std::string name = stage.starts_with("write ")          ? "files"
                             : stage.starts_with("effect ")       ? stage.substr(7)
                             : stage == "predicted error budget"  ? "error budget"
                             : stage == "measure transform error" ? "check of the transform"
                                                                  : stage;
    parts.add(name, seconds);
    told += seconds;
  }
  if (summary.seconds > told) parts.add("other", summary.seconds - told);
  std::vector<std::pair<std::string, double>> rows = parts.stages();
  std::stable_sort(rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
  std::string text;
  for (const auto& [name, seconds] : rows)
    if (text.empty() || seconds >= 0.01 * summary.seconds)
      text += fmt::format("{}{} {:.2f}", text.empty() ? "" : ", ", name, seconds);
  return text;
}

std::string place_text(const Vector& place, int dimension) {
  std::string text;
  for (int k = 0; k < dimension; ++k)
    text += fmt::format("{}{:.4g}", k ? ", " : "(", place[static_cast<std::size_t>(k)]);
  return text + ")";
}

std::string left_out_text(const Case& scene, const SeedReport& seeding) {
  std::string parts = fmt::format("{:.1e} of the mass", seeding.carried.front().part());
  if (seeding.carried.size() > 1) parts += fmt::format(", {:.1e} of the charge", seeding.carried.back().part());
  return fmt::format("left out {} lattice points with less than {:g} of the largest weight: {} (particles.threshold)\n",
                     seeding.left_out, scene.particles.threshold, parts);
}

std::string ending_text(const Case& scene, const RunSummary& summary, const accuracy::Budget* budget,
                        std::optional<double> target, const fs::path& folder) {
  std::string text;
  double worst = 0;
  for (const auto& [time, numbers] : summary.frames) worst = std::max(worst, numbers.transform_error);
  text += fmt::format("done   {} particles, {} steps, {} frames in {:.2f} s on {} threads ({})\n", summary.particles,
                      summary.steps, summary.frames.size(), summary.seconds, summary.threads, seconds_text(summary));
  if (!summary.frames.empty()) {
    const auto extremes = [](const FrameNumbers& numbers) {
      return numbers.minimum < 0 ? fmt::format("rho in [{:.6g}, {:.6g}]", numbers.minimum, numbers.maximum)
                                 : fmt::format("max rho = {:.6g}", numbers.maximum);
    };
    const auto& [t0, first] = summary.frames.front();
    const auto& [t1, last] = summary.frames.back();
    std::string heights = fmt::format("{} at t = {:.4g}", extremes(first), t0);
    if (summary.frames.size() > 1) heights += fmt::format(", {} at t = {:.4g}", extremes(last), t1);
    text += fmt::format("result {}; mass {:.9g}; Gauss transform right to {:.0e} of max rho ({:.0e} asked)\n", heights,
                        last.mass, worst, scene.evaluate.tolerance);
  }
  if (summary.seeding.left_out > 0) text += left_out_text(scene, summary.seeding);
  if (!summary.frames.empty() && !summary.frames.back().second.no_norms.empty())
    text +=
        fmt::format("error  at t = {:.4g} {}\n", summary.frames.back().first, summary.frames.back().second.no_norms);
  else if (!summary.frames.empty() && summary.frames.back().second.error) {
    const auto& [time, numbers] = summary.frames.back();
    const std::string where = numbers.compared < summary.grid_points
                                  ? fmt::format(", on {} of {} grid points", numbers.compared, summary.grid_points)
                                  : "";
    const std::string how = summary.reference_word.empty() ? "" : ", " + summary.reference_word;
    text += fmt::format("error  at t = {:.4g}, relative to the exact density{}{}: L1 {:.2e}, L2 {:.2e}, Linf {:.2e}\n",
                        time, where, how, numbers.error->l1, numbers.error->l2, numbers.error->linf);
  }
  if (const auto* hardest = worst_output(summary.frames); hardest && hardest->first != summary.frames.back().first)
    text += fmt::format("worst  at t = {:.4g}: L1 {:.2e}, L2 {:.2e}, Linf {:.2e}\n", hardest->first,
                        hardest->second.error->l1, hardest->second.error->l2, hardest->second.error->linf);
  if (target && !summary.frames.empty() && !summary.frames.back().second.no_norms.empty()) {
    text +=
        fmt::format("target {:g}: not known whether it is met, {}\n", *target, summary.frames.back().second.no_norms);
  } else if (target && !summary.frames.empty() && summary.frames.back().second.error) {
    const double achieved = summary.frames.back().second.error->linf;
    text += fmt::format("target {:g}: achieved {:.2e}{}\n", *target, achieved, achieved <= *target ? "" : ", MISSED");
  }
  if (budget && budget->known()) {
    text += fmt::format("budget {}\n", one_line(*budget));
    for (const std::string& advice : budget->advice) text += fmt::format("hint   {}\n", advice);
  } else if (budget) {
    text += fmt::format("budget none: {}\n", budget->not_covered);
  }
  for (const CheckResult& result : summary.checks)
    text += fmt::format("check  {}: {}\n", result.passed ? "passed" : "FAILED", result.text);
  const bool pictures = fs::exists(folder / "images");
  const bool density = fs::exists(folder / "density.pvd");
  text += fmt::format("open   {}{}{}{}\n",
                      fs::is_regular_file(folder / "report.html") ? (folder / "report.html").string() + ", " : "",
                      density ? (folder / "density.pvd").string() + " in ParaView" : (folder / "series.csv").string(),
                      pictures ? ", pictures in " : "", pictures ? (folder / "images").string() : "");
  return text;
}

/// Lines for the end of the run: what the page does without.
std::string write_page(const fs::path& folder, const Case& scene, OwedFiles& owed) {
  std::string without;
  try {
    const report::ReportFiles page = report::write_report(folder, !scene.output.images.empty());
    for (const std::string& what : page.left_out) without += fmt::format("page   without {}\n", what);
    const bool there =
        std::find(page.written.begin(), page.written.end(), folder / "report.html") != page.written.end();
    for (const std::string& why : page.failed)
      owed.miss(fmt::format("{}: {}; gaussdrift report {} makes it later",
                            there ? "the page about this run is not complete" : "there is no page about this run", why,
                            folder.string()));
  } catch (const std::exception& error) {  // what was computed stands in the other files, and its checks count
    owed.miss(fmt::format("there is no page about this run: {}; gaussdrift report {} makes it later", error.what(),
                          folder.string()));
  }
  return without;
}

/// Data files are named as seen from the run's folder. The hash has their bytes and bare names: where they lie is of no
/// interest to the result.
std::string provenance_of(const Case& scene, const fs::path& folder, const RunOptions& options) {
  std::vector<write::DataFile> data;
  for (const fs::path& file : input::data_files(scene))
    data.push_back({input::seen_from(folder, file).generic_string(), file});
  return write::provenance_json(scene, input::resolved_toml(input::with_bare_names(scene)), data, options.command,
                                base::resolve_threads(options.scene.threads));
}

/// Warnings: facts that the results do not show by themselves. For the terminal, the page and the log.
std::vector<std::string> warnings_of(const Case& scene, const RunSummary& summary) {
  std::vector<std::string> warnings;
  if (summary.transform_achievable > scene.evaluate.tolerance)
    warnings.push_back(
        fmt::format("evaluate.tolerance = {:.1e} cannot be promised for these weights. The error of the sum is at most "
                    "{:.1e} of max rho.",
                    scene.evaluate.tolerance, summary.transform_achievable));
  Case remeshed = scene;
  remeshed.effects.remesh = RemeshSpec{};
  for (const auto& [time, numbers] : summary.frames)
    if (numbers.stretch > scene.particles.overlap) {
      warnings.push_back(fmt::format(
          "at t = {:.4g} particles that start as neighbours are up to {:.3g} spacings apart. Blobs {:g} spacings wide "
          "no longer overlap there, so the density has false gaps and peaks. Use {}more overlap on a finer lattice.",
          time, numbers.stretch, scene.particles.overlap,
          accuracy::why_not_read(remeshed).empty() ? "[effects.remesh], or " : ""));
      break;
    }
  warnings.insert(warnings.end(), summary.warnings.begin(), summary.warnings.end());
  for (const EffectSummary& effect : summary.effects)
    if (!effect.warning.empty()) warnings.push_back(fmt::format("{}: {}", effect.name, effect.warning));
  if (summary.reference.untraced > 0)
    warnings.push_back(
        fmt::format("the exact density is not known at {} grid points of all outputs (one is {}: {}); the norms of the "
                    "error leave them out",
                    summary.reference.untraced, place_text(summary.reference.first_untraced, scene.domain.dimension),
                    summary.reference.trouble));
  for (const std::string& text : {about_leaving(summary.frames), about_beyond(summary.beyond_at_start)})
    if (!text.empty()) warnings.push_back(text);
  return warnings;
}

bool budgeted(const Case& scene) {
  return scene.accuracy.budget != AccuracySpec::Budget::none && scene.reference.kind != ReferenceSpec::Kind::none;
}

/// Finds out more about a finished run: where its error comes from, and what digits cost. The run does not depend on
/// it, so a failure is a warning.
std::optional<accuracy::Budget> look_back(const Case& scene, RunSummary& summary, const accuracy::LastFrame::Kept& last,
                                          nlohmann::ordered_json& more, std::vector<std::string>& warnings,
                                          int threads) {
  const auto stage = [&](const char* name, const auto& work) {
    const base::Stopwatch watch;
    try {
      work();
    } catch (const std::exception& error) {
      warnings.push_back(fmt::format("no {}: {}", name, error.what()));
    }
    const double seconds = watch.seconds();
    summary.stages.add(name, seconds);
    summary.seconds += seconds;
  };
  std::optional<accuracy::Budget> measured, predicted;
  if (budgeted(scene)) {
    const auto effort = scene.accuracy.budget == AccuracySpec::Budget::measured ? accuracy::Effort::whatever
                                                                                : accuracy::Effort::share_of_run;
    stage("error budget",
          [&] { measured = accuracy::measure_budget(scene, make_scene(scene, threads), last, effort, threads); });
    stage("predicted error budget",
          [&] { predicted = accuracy::predict_budget(scene, make_scene(scene, threads), effort, threads); });
  }
  if (measured && predicted)
    more["budget"] = {{"norm", "largest error at the last output, relative to the largest exact density there"},
                      {"predicted", accuracy::to_json(*predicted)},
                      {"measured", accuracy::to_json(*measured)},
                      {"advice", measured->advice}};
  if (scene.output.report)
    stage("accuracy table", [&] { more.update(accuracy::accuracy_table(scene, summary, last, threads)); });
  return measured;
}

}  // namespace

ExitCode run(const RunOptions& options) {
  const Case asked = read(options.scene), scene = settled(asked, options.scene);
  const fs::path folder = options.folder.empty() ? fs::path("output") / scene.name : options.folder;
  accuracy::refuse_what_does_not_fit(scene, options.scene.threads);
  Simulation simulation(scene, options.scene.threads);
  simulation.prepare();  // what cannot begin must not cost an earlier run
  const std::string provenance = provenance_of(scene, folder, options);
  write::prepare_run_folder(folder, options.force);
  write::write_run_inputs(folder, scene, input::resolved_toml(scene, folder));
  write::write_text(folder / "provenance.json", provenance);
  add_observers(simulation, scene, folder);
  accuracy::LastFrame::Kept last;
  if ((budgeted(scene) && accuracy::budget_not_covered(scene).empty()) || scene.output.report)
    simulation.observe(std::make_unique<accuracy::LastFrame>(last, scene.output.times.back()));

  RunSummary summary;
  {
    ProgressLine line;
    simulation.on_progress([&](const Progress& progress) { line.show(progress); });
    summary = simulation.run();
  }
  std::vector<std::string> warnings = warnings_of(scene, summary);
  nlohmann::ordered_json more;
  const std::optional<accuracy::Budget> measured =
      look_back(scene, summary, last, more, warnings, options.scene.threads);
  if (const auto target = asked.accuracy.target; target && !summary.frames.empty()) {
    const auto& error = summary.frames.back().second.error;
    const bool known = error && std::isfinite(error->linf);
    more["accuracy"] = {{"target", *target},
                        {"achieved", known ? nlohmann::ordered_json(error->linf) : nlohmann::ordered_json()},
                        {"met", known && error->linf <= *target}};
    if (const std::string& why = summary.frames.back().second.no_norms; !why.empty())
      more["accuracy"]["not_known"] = why;
  }
  if (!warnings.empty()) more["warnings"] = warnings;
  const std::string json = write::summary_json(scene, summary, more);

  // Every file before the first word: a terminal that takes no text costs no result.
  OwedFiles owed;
  std::string without;
  if (owed.attempt([&] { write::write_text(folder / "summary.json", json); }) && scene.output.report)
    without = write_page(folder, scene, owed);
  const std::string ending =
      ending_text(scene, summary, measured ? &*measured : nullptr, asked.accuracy.target, folder) + without;
  std::string log;
  for (const std::string& warning : warnings) log += "warning: " + warning + "\n";
  for (const std::string& why : owed.missing()) log += "error: " + why + "\n";
  owed.attempt([&] { write::write_text(folder / "log.txt", base::printable_lines(log + ending)); });

  for (const std::string& warning : warnings) note("warning: {}\n", warning);
  put(stdout, options.scene.json ? json : ending);
  bool failed = false;
  for (const CheckResult& result : summary.checks) {
    if (result.passed) continue;
    failed = true;
    note("check failed: {}\n", result.text);
  }
  for (const std::string& why : owed.missing()) note("error: {}\n", why);
  return failed ? ExitCode::check : owed.missing().empty() ? ExitCode::ok : ExitCode::files;
}

ExitCode check(const CaseOptions& options) {
  const Case scene = settled(read(options), options);
  accuracy::Description description;
  {
    ProgressLine line(1);
    description =
        accuracy::describe(scene, options.threads, [&](const std::string& what) { line.show("check: " + what); });
  }
  say("{}", options.json ? accuracy::to_json(scene, description) : accuracy::to_text(scene, description));
  return ExitCode::ok;
}

namespace {

ExitCode reproduce_cone(const ReproduceOptions& options) {
  if (!options.table.empty() || options.full)
    throw CommandLineError(
        "the cone has no tables to choose from and no --full; that is for: reproduce fgtd, divergence, figures");
  reproduce::ConeReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_cone(options.threads, [&](std::size_t done, std::size_t total) {
      line.show(fmt::format("{} of {} heights", done, total));
    });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return result.worst_difference <= reproduce::cone_agreement ? ExitCode::ok : ExitCode::check;
}

ExitCode reproduce_claims(const ReproduceOptions& options) {
  if (!options.table.empty() || options.full)
    throw CommandLineError(
        "the claims have no tables to choose from and no --full; that is for: reproduce fgtd, divergence, figures");
  reproduce::ClaimsOptions claims;
  if (options.threads > 0) claims.threads = options.threads;
  reproduce::ClaimsReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_claims(claims, [&](const std::string& what) { line.show(what); });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return ExitCode::ok;
}

ExitCode reproduce_coulomb(const ReproduceOptions& options) {
  if (!options.table.empty()) throw CommandLineError("coulomb is one table; leave the number away");
  reproduce::CoulombOptions coulomb;
  if (options.threads > 0) coulomb.threads = options.threads;
  if (options.full) {
    coulomb.most_particles = 6'400'000;
    coulomb.most_by_pairs = 100'000;
  }
  reproduce::CoulombReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_coulomb(
        coulomb, [&](std::size_t particles) { line.show(fmt::format("{} particles", particles)); });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return result.disagreements.empty() ? ExitCode::ok : ExitCode::check;
}

ExitCode reproduce_logkernel(const ReproduceOptions& options) {
  if (!options.table.empty()) throw CommandLineError("logkernel has no tables to choose from; leave the number away");
  reproduce::LogKernelOptions logkernel;
  logkernel.folder = options.folder.empty() ? fs::path("output") / "logkernel" : options.folder;
  if (options.full) logkernel.largest_dense = 14;
  reproduce::LogKernelReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_logkernel(logkernel, [&](const std::string& what) { line.show(what); });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return ExitCode::ok;
}

ExitCode reproduce_tables(reproduce::TableSet set, const ReproduceOptions& options) {
  reproduce::FgtdOptions fgtd = options.full ? reproduce::FgtdOptions::everything() : reproduce::FgtdOptions{};
  fgtd.set = set;
  fgtd.table = options.table;
  fgtd.threads = options.threads;
  reproduce::FgtdReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_fgtd(fgtd, [&](const std::string& table) { line.show(table); });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return result.disagreements.empty() ? ExitCode::ok : ExitCode::check;
}

ExitCode reproduce_figures(const ReproduceOptions& options) {
  const reproduce::FiguresOptions figures{
      .figure = options.table,
      .folder = options.folder.empty() ? fs::path("output") / "figures" : options.folder,
      .full = options.full,
      .threads = options.threads};
  std::vector<reproduce::Figure> made;
  {
    ProgressLine line;
    made = reproduce::reproduce_figures(figures, [&](const std::string& figure) { line.show(figure); });
  }
  say("{}", options.json ? reproduce::to_json(made) : reproduce::to_text(made));
  return ExitCode::ok;
}

}  // namespace

ExitCode reproduce(const ReproduceOptions& options) {
  if (!options.folder.empty() && options.what != "figures" && options.what != "logkernel")
    throw CommandLineError("--out goes with: reproduce figures, logkernel");
  if (options.what == "figures") return reproduce_figures(options);
  if (options.what == "coulomb") return reproduce_coulomb(options);
  if (options.what == "logkernel") return reproduce_logkernel(options);
  if (options.what == "claims") return reproduce_claims(options);
  if (options.what == "cone") return reproduce_cone(options);
  if (options.what == "fgtd") return reproduce_tables(reproduce::TableSet::fgtd, options);
  if (options.what == "divergence") return reproduce_tables(reproduce::TableSet::divergence, options);
  if (!options.what.empty())
    throw CommandLineError(
        fmt::format("nothing called \"{}\" can be reproduced; there are: cone, fgtd, divergence, figures, claims, "
                    "coulomb, logkernel",
                    options.what));
  say("tables that can be reproduced:\n"
      "  cone        heights of the rotating cone, Tables 5.1 and 5.2 of Schroeder 2006\n"
      "  fgtd        errors and times of the fast Gauss transform, Tables {} of Schroeder 2006; one: fgtd 4.6\n"
      "  divergence  divergence-free Gaussian fields, Tables {} of Schroeder 2006; one: divergence 6.1\n"
      "  figures     pictures {} of Schroeder 2006, drawn into output/figures; one: figures 5.3\n"
      "  claims      what the text of Schroeder 2006 claims outside its tables, and whether it holds\n"
      "  coulomb     forces between many particles by tree and symmetric interpolation, the table of Boerm 2022\n"
      "  logkernel   ln|x - y| in blocks of low rank: storage, error, products; the exercises of Melenk's project 6\n",
      fmt::join(reproduce::table_numbers(reproduce::TableSet::fgtd), ", "),
      fmt::join(reproduce::table_numbers(reproduce::TableSet::divergence), " and "),
      fmt::join(reproduce::figure_numbers(), ", "));
  return ExitCode::ok;
}

}  // namespace gaussdrift::cli
