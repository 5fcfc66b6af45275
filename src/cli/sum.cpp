// gaussdrift sum: tables in, a table out.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <new>
#include <string>
#include <vector>

#include "accuracy/memory_limits.hpp"
#include "base/size_text.hpp"
#include "base/stopwatch.hpp"
#include "base/suggest.hpp"
#include "cli/asked_case.hpp"
#include "cli/stage_line.hpp"
#include "cli/sum_options.hpp"
#include "cli/sum_output.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "input/points_table.hpp"
#include "rbf/rbf.hpp"
#include "sum/density.hpp"
#include "sum/derivatives.hpp"
#include "sum/general.hpp"
#include "sum/pairs.hpp"
#include "sum/points.hpp"
#include "sum/radial.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// The one of that name; to_string() of the library that `all` comes from.
template <class Choice>
Choice named(const char* option, const std::string& name, const std::vector<Choice>& all) {
  std::vector<std::string> names;
  for (const Choice choice : all) {
    names.push_back(to_string(choice));
    if (names.back() == name) return choice;
  }
  const auto meant = base::suggest(name, names);
  throw CommandLineError(fmt::format("{}: there is no \"{}\"{}; there are {}", option, name,
                                     meant ? fmt::format(", is \"{}\" meant?", *meant) : "", fmt::join(names, ", ")));
}

/// Reads what every kernel needs; returns the seconds that it took.
double read_points(const SumOptions& options, sum::PointsRequest& request, StageLine& stages) {
  request.tolerance = tolerance_of(options);
  request.threads = options.threads;
  constexpr double most_if_named = 300;
  if (options.seconds)
    request.most_seconds = *options.seconds;
  else if (options.method != "auto" || by_hand(options))
    request.most_seconds = most_if_named;
  request.tell = [&stages](const std::string& what) { stages.aside([&] { note("{}\n", what); }); };
  request.predicted = [&stages](double seconds) { stages.expect(seconds); };
  if (!options.grid.empty()) request.grid = sum::parse_grid(options.grid);
  const input::PointsColumns columns{sum::parse_columns(options.columns, options.weight), options.weight,
                                     options.normalise};
  // Nearly all that a limit leaves; the rest is for the program.
  const accuracy::MemoryLimit limit = accuracy::tightest_limit(most_memory(options.memory));
  if (limit.left() <= 0)
    throw InputError(fmt::format("{} {}, and the program itself takes {} before it reads a point; allow more memory",
                                 limit.who, base::size_text(limit.bytes), base::size_text(limit.taken)));
  const double left = 0.9 * limit.left();
  request.memory_limit = static_cast<std::size_t>(std::min(static_cast<double>(request.memory_limit), left));
  const base::Stopwatch reading;
  const auto read = [&](const fs::path& file, input::PointsRole role) {
    stages.begin(fmt::format("reading {}", file == input::standard_input ? "standard input" : file.string()));
    input::PointsTable table = input::read_points_table(file, role, request.memory_limit, columns);
    for (const std::string& doubt : table.doubts) stages.aside([&] { note("warning: {}\n", doubt); });
    return table;
  };
  request.sources = read(options.sources, input::PointsRole::sources);
  if (!options.targets.empty()) request.targets = read(options.targets, input::PointsRole::targets);
  stages.begin("summing");
  return reading.seconds();
}

/// Writes the values and tells about them; Sums is that of one library. A promise that is found broken is exit code 4.
template <class Sums>
ExitCode write(Sums& sums, const sum::PointsRequest& request, const SumOptions& options, StageLine& stages) {
  if (options.method != "auto" && sums.asked != sums.choice.method)
    stages.aside([&] {
      note("warning: {} is not possible for these points, targets and tolerance; {} did the sum\n", options.method,
           to_string(sums.choice.method));
    });
  const base::Stopwatch writing;
  stages.begin("writing");
  write_values({options.out, sums.columns, request.grid}, sums.values);
  stages.end();
  sums.write_seconds = writing.seconds();
  if (options.json)
    say("{}", sum::to_json(sums));
  else if (!to_standard_output(options))
    say("{}open   {}\n", sum::to_text(sums), options.out.string());
  const std::vector<std::string> broken = sum::broken_promises(sums.measured, sums.compared);
  for (const std::string& sentence : broken) note("warning: {}\n", sentence);
  return broken.empty() ? ExitCode::ok : ExitCode::numerical;
}

ExitCode sum_gaussians(const SumOptions& options) {
  sum::SumRequest request;
  request.sigma = options.sigma.value_or(0);
  request.method = named("--method", options.method, fgtd::methods());
  if (by_hand(options)) {
    fgtd::HermiteParameters& given = request.hermite.emplace();
    given.box_scale = options.r.value_or(given.box_scale);
    given.expansion_order = options.p.value_or(given.expansion_order);
    if (!options.n.empty()) given.neighbours = sum::parse_neighbours(options.n);
  }
  for (const std::string& text : options.derivatives) request.derivatives.push_back(sum::parse_derivative(text));
  StageLine stages;
  const double read_seconds = read_points(options, request, stages);
  sum::PointSums sums = sum::sum_shaped(request, {bandwidth_of(options), options.normalise});
  sums.read_seconds = read_seconds;
  return write(sums, request, options, stages);
}

ExitCode sum_pairs(const SumOptions& options) {
  sum::PairSumRequest request;
  request.kernel = named("--kernel", options.kernel, farfield::kernels());
  request.method = named("--method", options.method, farfield::methods());
  StageLine stages;
  const double read_seconds = read_points(options, request, stages);
  sum::PairSums sums = sum::sum_pairs(request);
  sums.read_seconds = read_seconds;
  return write(sums, request, options, stages);
}

ExitCode sum_general(const SumOptions& options) {
  sum::GeneralSumRequest request;
  request.kernel = options.kernel;
  request.method = named("--method", options.method, farfield::general_methods());
  StageLine stages;
  const double read_seconds = read_points(options, request, stages);
  sum::GeneralSums sums = sum::sum_general(request);
  sums.read_seconds = read_seconds;
  return write(sums, request, options, stages);
}

ExitCode sum_radial(const SumOptions& options) {
  sum::RadialSumRequest request;
  request.function = {*rbf::kernel_named(options.kernel), options.shape.value_or(0)};
  request.method = named("--method", options.method, rbf::methods());
  for (const std::string& text : options.derivatives) request.derivatives.push_back(sum::parse_derivative(text));
  StageLine stages;
  const double read_seconds = read_points(options, request, stages);
  sum::RadialSums sums = sum::sum_radial(request);
  sums.read_seconds = read_seconds;
  return write(sums, request, options, stages);
}

ExitCode sum(const SumOptions& options) {
  check_sum_options(options);
  try {
    if (of_expression(options)) return sum_general(options);
    if (of_radial(options)) return sum_radial(options);
    return of_pairs(options) ? sum_pairs(options) : sum_gaussians(options);
  } catch (const std::bad_alloc&) {
    throw InputError("out of memory; ask for fewer targets at a time, or give fewer sources");
  }
}

}  // namespace

Verb sum_verb() {
  return make_verb<SumOptions>(
      "sum", "sum Gaussians, radial kernels, Coulomb charges or logarithms over a table of points", declare_sum, sum);
}

}  // namespace gaussdrift::cli
