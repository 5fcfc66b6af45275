// gaussdrift reproduce: tables, figures and claims of the literature, made again.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "cli/output_name.hpp"
#include "cli/progress.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/error.hpp"
#include "render/picture.hpp"
#include "reproduce/claims.hpp"
#include "reproduce/cone.hpp"
#include "reproduce/coulomb.hpp"
#include "reproduce/fgtd.hpp"
#include "reproduce/figures.hpp"
#include "reproduce/interpolation.hpp"
#include "reproduce/kernels.hpp"
#include "reproduce/logkernel.hpp"
#include "reproduce/rbf.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct ReproduceOptions {
  std::string what;              // "cone", "fgtd", ...; empty: a list
  std::string table;             // of fgtd or divergence, or a figure, as in 4.6; empty: all
  std::filesystem::path folder;  // --out, of figures; empty: output/figures
  bool full = false;             // fgtd, divergence: every row, and no samples of targets; figures: the thesis's steps
  int threads = 0;               // 0: all
  bool json = false;
};

void declare(OptionList& options, ReproduceOptions& given) {
  options.add("what", given.what, "WHAT", "what to reproduce. Without it, a list");
  options.add("table,--table", given.table, "TABLE",
              "one table of fgtd or divergence, or one figure, such as 4.6. By default all");
  options.add("--out", given.folder, "DIR",
              "folder for figures or for logkernel; output/figures or output/logkernel by default");
  options.flag("--full", given.full,
               "fgtd, divergence, coulomb: also the largest rows, and every target compared; figures: 5.3 with the "
               "thesis's steps; kernels, rbf, interpolation: more points");
  options.threads(given.threads);
  options.json(given.json);
}

ExitCode reproduce_cone(const ReproduceOptions& options) {
  if (!options.table.empty() || options.full)
    throw CommandLineError(
        "the cone has no tables to choose from and no --full; these belong to: reproduce fgtd, divergence, figures");
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
        "the claims have no tables to choose from and no --full; these belong to: reproduce fgtd, divergence, figures");
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
  if (!options.table.empty()) throw CommandLineError("coulomb is one table; leave the number out");
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
  if (!options.table.empty()) throw CommandLineError("logkernel has no tables to choose from; leave the number out");
  reproduce::LogKernelOptions logkernel;
  logkernel.folder = options.folder.empty() ? fs::path("output") / "logkernel" : options.folder;
  if (options.full) logkernel.largest_dense = 14;
  reproduce::LogKernelReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_logkernel(logkernel, [&](const std::string& what) { line.show(what); });
  }
  if (const std::string reason = render::unavailable_reason(); !reason.empty())
    note("warning: no plots are drawn: {}\n", reason);
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return ExitCode::ok;
}

ExitCode reproduce_kernels(const ReproduceOptions& options) {
  if (!options.table.empty()) throw CommandLineError("kernels has no tables to choose from; leave the number out");
  reproduce::KernelsOptions kernels;
  if (options.threads > 0) kernels.threads = options.threads;
  if (options.full) kernels.points = 100'000;
  reproduce::KernelsReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_kernels(kernels, [&](const std::string& what) { line.show(what); });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return result.kept() ? ExitCode::ok : ExitCode::check;
}

ExitCode reproduce_rbf(const ReproduceOptions& options) {
  if (!options.table.empty()) throw CommandLineError("rbf has no tables to choose from; leave the number out");
  reproduce::RbfOptions rbf;
  if (options.threads > 0) rbf.threads = options.threads;
  if (options.full) rbf.points = 100'000;
  reproduce::RbfReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_rbf(rbf, [&](const std::string& what) { line.show(what); });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return result.kept() ? ExitCode::ok : ExitCode::check;
}

ExitCode reproduce_interpolation(const ReproduceOptions& options) {
  if (!options.table.empty())
    throw CommandLineError("interpolation has no tables to choose from; leave the number out");
  reproduce::InterpolationOptions interpolation;
  if (options.threads > 0) interpolation.threads = options.threads;
  if (options.full) interpolation.most_points = 64'000;
  reproduce::InterpolationReproduction result;
  {
    ProgressLine line;
    result = reproduce::reproduce_interpolation(interpolation, [&](const std::string& what) { line.show(what); });
  }
  say("{}", options.json ? reproduce::to_json(result) : reproduce::to_text(result));
  return result.agrees() ? ExitCode::ok : ExitCode::check;
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

ExitCode reproduce(const ReproduceOptions& options) {
  check_folder_name(options.folder, "pictures are written into a folder");
  if (!options.folder.empty() && options.what != "figures" && options.what != "logkernel")
    throw CommandLineError("--out goes with: reproduce figures, logkernel");
  if (options.what == "figures") return reproduce_figures(options);
  if (options.what == "coulomb") return reproduce_coulomb(options);
  if (options.what == "kernels") return reproduce_kernels(options);
  if (options.what == "rbf") return reproduce_rbf(options);
  if (options.what == "interpolation") return reproduce_interpolation(options);
  if (options.what == "logkernel") return reproduce_logkernel(options);
  if (options.what == "claims") return reproduce_claims(options);
  if (options.what == "cone") return reproduce_cone(options);
  if (options.what == "fgtd") return reproduce_tables(reproduce::TableSet::fgtd, options);
  if (options.what == "divergence") return reproduce_tables(reproduce::TableSet::divergence, options);
  if (!options.what.empty())
    throw CommandLineError(
        fmt::format("nothing called \"{}\" can be reproduced; there are: cone, fgtd, divergence, figures, claims, "
                    "coulomb, logkernel, kernels, rbf, interpolation",
                    options.what));
  say("gaussdrift reproduce WHAT computes published numbers again. There are:\n"
      "  cone           heights of the rotating cone, Tables 5.1 and 5.2 of Schroeder 2006\n"
      "  fgtd           errors and times of the fast Gauss transform, Tables {} of Schroeder 2006; one: fgtd 4.6\n"
      "  divergence     divergence-free Gaussian fields, Tables {} of Schroeder 2006; one: divergence 6.1\n"
      "  figures        pictures {} of Schroeder 2006, drawn into output/figures; one: figures 5.3\n"
      "  claims         what the text of Schroeder 2006 claims outside its tables, and whether it holds\n"
      "  coulomb        forces between many particles by tree and symmetric interpolation, the table of Boerm 2022\n"
      "  logkernel      ln|x - y| in blocks of low rank: storage, error, products; the exercises of Melenk's project "
      "6\n"
      "  kernels        interpolation, recompression and orders by level for general kernels: rates, storage, sums\n"
      "  rbf            sums of radial kernels by Gaussians, those of Roussos and Baxter 2005 and others, beside all "
      "pairs\n"
      "  interpolation  Franke's function at random points: errors, rates, both solvers, integrals\n",
      fmt::join(reproduce::table_numbers(reproduce::TableSet::fgtd), ", "),
      fmt::join(reproduce::table_numbers(reproduce::TableSet::divergence), " and "),
      fmt::join(reproduce::figure_numbers(), ", "));
  return ExitCode::ok;
}

}  // namespace

Verb reproduce_verb() {
  return make_verb<ReproduceOptions>("reproduce", "compute a published table again, beside the published numbers",
                                     declare, reproduce);
}

}  // namespace gaussdrift::cli
