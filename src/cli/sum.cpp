// gaussdrift sum: tables in, a table out.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "accuracy/memory_limits.hpp"
#include "base/size_text.hpp"
#include "base/stopwatch.hpp"
#include "base/suggest.hpp"
#include "cli/asked_case.hpp"
#include "cli/output_name.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "input/points_table.hpp"
#include "rbf/rbf.hpp"
#include "sum/derivatives.hpp"
#include "sum/general.hpp"
#include "sum/pairs.hpp"
#include "sum/points.hpp"
#include "sum/radial.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct SumOptions {
  std::string kernel = "gauss";
  fs::path sources, targets;  // targets empty: --grid, or the sources
  std::string columns;        // "x,y"; empty: all but the weight
  std::string grid;           // "-1:1:200,-1:1:200"
  std::optional<double> sigma, shape;
  std::vector<std::string> derivatives;  // "0,1,2"; none: the plain sum
  std::optional<double> tolerance;       // 1e-6
  std::string method = "auto";
  std::optional<double> r;  // of `hermite` by hand, as are the next two
  std::optional<int> p;
  std::string n;                  // a number or "all"; empty: not given
  std::optional<double> seconds;  // most that may be predicted; by default 300 for a method that is named
  fs::path out;                   // empty or "-": standard output
  std::string memory;             // --memory; empty: at most 8 GB
  int threads = 0;                // 0: all
  bool json = false;              // what was chosen as JSON on stdout
};

std::vector<std::string> radial_names() {
  std::vector<std::string> names;
  for (const rbf::Kernel kernel : rbf::kernels()) names.push_back(to_string(kernel));
  return names;
}

void declare(OptionList& options, SumOptions& given) {
  options.add("--sources", given.sources, "FILE", "table of sources (CSV): coordinates and a column weight").required();
  const Option targets = options.add("--targets", given.targets, "FILE", "table of targets. By default the sources");
  options.add("--columns", given.columns, "NAME,...",
              "the columns that are coordinates: --columns x,y. By default all but weight");
  options
      .add("--grid", given.grid, "LOW:HIGH:COUNT,...",
           "a grid of targets: --grid=-1:1:200,0:1:100. Its first axis runs fastest")
      .excludes(targets);
  options.add("--sigma", given.sigma, "X", "of the Gaussian exp(-sigma r^2)");
  options.add("--shape", given.shape, "C", "c of a radial kernel, a length: --kernel multiquadric --shape 0.3");
  options
      .add("--derivative", given.derivatives, "A1,A2,...",
           "a derivative of the Gaussians or of a radial kernel: --derivative 0,1,2. Repeatable. By default the plain "
           "sum")
      .repeatable();
  const Option tolerance =
      options.add("--tolerance", given.tolerance, "X",
                  "error of every term (docs/fgtd.md, docs/farfield.md, docs/rbf.md); 1e-6 by default");
  options.add("--method", given.method, "NAME",
              "auto (the default), or a method of the library. A wrong name is answered with the list, and gaussdrift "
              "explain NAME tells what one does");
  options
      .add("--r", given.r, "R",
           "by hand: boxes of the method hermite have the side r sqrt(2/sigma); 0.5 by default. The error is bounded "
           "for r < 1, and told")
      .excludes(tolerance);
  options.add("--p", given.p, "P", "by hand: terms of its series on each axis; 9 by default").excludes(tolerance);
  options
      .add("--n", given.n, "N",
           "by hand: boxes to each side, on each axis, whose sources count, or all; all by default")
      .excludes(tolerance);
  options.add("--seconds", given.seconds, "S",
              "refuse a sum that is predicted to take longer; 300 by default for a method that you name");
  options.add("--kernel", given.kernel, "NAME",
              fmt::format("gauss (the default), coulomb (2D, 3D) or log (1D, 2D). The last two give potential and "
                          "field. A radial kernel (1D to 3D): {}. Or an expression of the distance r (2D, 3D): "
                          "--kernel \"exp(-r)/r\"",
                          fmt::join(radial_names(), ", ")));
  options.add("--out", given.out, "FILE", "file for the values. By default, or as -, standard output");
  declare_memory(options, given.memory);
  options.threads(given.threads);
  options.json(given.json, "what was chosen and what it cost, as JSON on standard output. Needs --out");
}

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

bool by_hand(const SumOptions& options) { return options.r || options.p || !options.n.empty(); }

double tolerance_of(const SumOptions& options) { return options.tolerance.value_or(1e-6); }

bool of_pairs(const SumOptions& options) { return options.kernel == "coulomb" || options.kernel == "log"; }

bool of_expression(const SumOptions& options) { return sum::is_kernel_expression(options.kernel); }

bool to_standard_output(const SumOptions& options) { return options.out.empty() || options.out == "-"; }

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

bool of_radial(const SumOptions& options) { return rbf::kernel_named(options.kernel).has_value(); }

void check_shape(const SumOptions& options) {
  if (!of_radial(options)) {
    if (options.shape)
      throw CommandLineError(fmt::format("--shape belongs to the radial kernels ({}), not to {}",
                                         fmt::join(radial_names(), ", "), options.kernel));
    return;
  }
  const rbf::Kernel kernel = *rbf::kernel_named(options.kernel);
  if (!rbf::takes_shape(kernel)) {
    if (options.shape) throw CommandLineError(fmt::format("--shape: {} takes none; leave it out", options.kernel));
    return;
  }
  if (!options.shape)
    throw CommandLineError(
        fmt::format("--shape is missing: {} is {}, and c is the shape", options.kernel, rbf::formula(kernel)));
  if (!(*options.shape > 0) || !std::isfinite(*options.shape))
    throw CommandLineError(fmt::format("--shape {}: must be positive and finite", *options.shape));
}

/// What belongs to the kernel gauss alone, or nearly so.
void check_not_of_gauss(const SumOptions& options) {
  if (options.sigma)
    throw CommandLineError(fmt::format(
        "--sigma belongs to the kernel gauss, not to {}{}", options.kernel,
        of_radial(options) && rbf::takes_shape(*rbf::kernel_named(options.kernel)) ? ", which takes --shape" : ""));
  if (!options.derivatives.empty() && of_pairs(options))
    throw CommandLineError(
        fmt::format("--derivative belongs to gauss and to radial kernels; {} gives potential and "
                    "field",
                    options.kernel));
  if (!options.derivatives.empty() && of_expression(options))
    throw CommandLineError(
        fmt::format("--derivative belongs to gauss and to radial kernels, not to {}", options.kernel));
  if (by_hand(options))
    throw CommandLineError(
        fmt::format("--r, --p and --n belong to the method hermite of the kernel gauss, not to {}", options.kernel));
  if (!(tolerance_of(options) > 0) || !(tolerance_of(options) < 1))
    throw CommandLineError(fmt::format("--tolerance {}: must lie in (0, 1)", tolerance_of(options)));
}

void check_gauss(const SumOptions& options) {
  if (!options.sigma) throw CommandLineError("--sigma is missing: the Gaussian is exp(-sigma r^2)");
  if (!(*options.sigma > 0) || !std::isfinite(*options.sigma))
    throw CommandLineError(fmt::format("--sigma {}: must be positive and finite", *options.sigma));
  if (!(tolerance_of(options) > 0) || !(tolerance_of(options) < 1))
    throw CommandLineError(
        fmt::format("--tolerance {}: must lie in [{}, 1)", tolerance_of(options), fgtd::smallest_tolerance));
  if (by_hand(options) && options.method != "auto" && options.method != to_string(fgtd::Method::hermite))
    throw CommandLineError(fmt::format("--r, --p and --n belong to the method hermite, not to {}", options.method));
}

[[noreturn]] void refuse_kernel(const std::string& kernel) {
  std::vector<std::string> names{"gauss", "coulomb", "log"};
  for (const std::string& name : radial_names()) names.push_back(name);
  const auto meant = base::suggest(kernel, names);
  throw CommandLineError(
      fmt::format("--kernel: there is no \"{}\"{}, and it is no expression of r as \"exp(-r)/r\"; there are {}", kernel,
                  meant ? fmt::format(", is \"{}\" meant?", *meant) : "", fmt::join(names, ", ")));
}

void check_options(const SumOptions& options) {
  if (options.kernel == "gauss") {
    check_shape(options);
    check_gauss(options);
  } else if (of_pairs(options) || of_expression(options) || of_radial(options)) {
    check_not_of_gauss(options);
    check_shape(options);
  } else {
    refuse_kernel(options.kernel);
  }
  if (options.seconds && !(*options.seconds > 0))
    throw CommandLineError(fmt::format("--seconds {}: must be positive", *options.seconds));
  if (to_standard_output(options)) {
    if (options.json)
      throw CommandLineError("--json writes to standard output, so the values need a file; add --out FILE");
    return;
  }
  for (const fs::path& input : {options.sources, options.targets})
    if (!input.empty() && same_file(input, options.out))
      throw CommandLineError(fmt::format("--out {} would replace a table that is read", options.out.string()));
  std::error_code ignored;
  if (fs::is_directory(options.out, ignored))
    throw FileError(fmt::format("cannot write {}: it is a folder; name a file with --out", options.out.string()));
}

/// A stream that is closed on the way out of an error.
class Output {
 public:
  explicit Output(const fs::path& file) : stream_(std::fopen(file.c_str(), "wb")) {
    if (!stream_) throw std::system_error(errno, std::generic_category());
  }
  ~Output() {
    if (stream_) std::fclose(stream_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  std::FILE* stream() const { return stream_; }
  void close() {
    if (std::fclose(std::exchange(stream_, nullptr)) != 0) throw std::system_error(errno, std::generic_category());
  }

 private:
  std::FILE* stream_;
};

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

void write_values(const std::vector<std::string>& columns, const Eigen::MatrixXd& values, const SumOptions& options) {
  std::error_code ignored;
  const bool special = fs::exists(options.out, ignored) && !fs::is_regular_file(options.out, ignored);
  try {
    if (to_standard_output(options))
      sum::write_table(columns, values, stdout);
    else if (special) {  // a pipe or a device is written to; a rename would replace it
      Output out(options.out);
      sum::write_table(columns, values, out.stream());
      out.close();
    } else {
      write::remove_what_killed_processes_left(folder_of(options.out));
      write::write_atomically(options.out, [&](std::FILE* out) { sum::write_table(columns, values, out); });
    }
  } catch (const std::system_error& error) {
    if (to_standard_output(options) && error.code() == std::errc::broken_pipe) return;  // as in: sum ... | head
    throw FileError(fmt::format("cannot write {}: {}",
                                to_standard_output(options) ? "to standard output" : options.out.string(),
                                error.code().message()));
  }
}

/// Reads what every kernel needs; returns the seconds that it took.
double read_points(const SumOptions& options, sum::PointsRequest& request) {
  request.tolerance = tolerance_of(options);
  request.threads = options.threads;
  constexpr double most_if_named = 300;
  if (options.seconds)
    request.most_seconds = *options.seconds;
  else if (options.method != "auto" || by_hand(options))
    request.most_seconds = most_if_named;
  request.tell = [](const std::string& what) { note("{}\n", what); };
  if (!options.grid.empty()) request.grid = sum::parse_grid(options.grid);
  const input::CoordinateNames coordinates = sum::parse_columns(options.columns);
  // Nearly all that a limit leaves; the rest is for the program.
  const accuracy::MemoryLimit limit = accuracy::tightest_limit(most_memory(options.memory));
  if (limit.left() <= 0)
    throw InputError(fmt::format("{} {}, and the program itself takes {} before it reads a point; allow more memory",
                                 limit.who, base::size_text(limit.bytes), base::size_text(limit.taken)));
  const double left = 0.9 * limit.left();
  request.memory_limit = static_cast<std::size_t>(std::min(static_cast<double>(request.memory_limit), left));
  const base::Stopwatch reading;
  const auto read = [&](const fs::path& file, input::PointsRole role) {
    input::PointsTable table = input::read_points_table(file, role, request.memory_limit, coordinates);
    for (const std::string& doubt : table.doubts) note("warning: {}\n", doubt);
    return table;
  };
  request.sources = read(options.sources, input::PointsRole::sources);
  if (!options.targets.empty()) request.targets = read(options.targets, input::PointsRole::targets);
  return reading.seconds();
}

/// Writes the values and tells about them; Sums is that of one library. A promise that is found broken is exit code 4.
template <class Sums>
ExitCode write(Sums& sums, const SumOptions& options) {
  if (options.method != "auto" && sums.asked != sums.choice.method)
    note("warning: {} is not possible for these points, targets and tolerance; {} did the sum\n", options.method,
         to_string(sums.choice.method));
  const base::Stopwatch writing;
  write_values(sums.columns, sums.values, options);
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
  request.sigma = *options.sigma;
  request.method = named("--method", options.method, fgtd::methods());
  if (by_hand(options)) {
    fgtd::HermiteParameters& given = request.hermite.emplace();
    given.box_scale = options.r.value_or(given.box_scale);
    given.expansion_order = options.p.value_or(given.expansion_order);
    if (!options.n.empty()) given.neighbours = sum::parse_neighbours(options.n);
  }
  for (const std::string& text : options.derivatives) request.derivatives.push_back(sum::parse_derivative(text));
  const double read_seconds = read_points(options, request);
  sum::PointSums sums = sum::sum_points(request);
  sums.read_seconds = read_seconds;
  return write(sums, options);
}

ExitCode sum_pairs(const SumOptions& options) {
  sum::PairSumRequest request;
  request.kernel = named("--kernel", options.kernel, farfield::kernels());
  request.method = named("--method", options.method, farfield::methods());
  const double read_seconds = read_points(options, request);
  sum::PairSums sums = sum::sum_pairs(request);
  sums.read_seconds = read_seconds;
  return write(sums, options);
}

ExitCode sum_general(const SumOptions& options) {
  sum::GeneralSumRequest request;
  request.kernel = options.kernel;
  request.method = named("--method", options.method, farfield::general_methods());
  const double read_seconds = read_points(options, request);
  sum::GeneralSums sums = sum::sum_general(request);
  sums.read_seconds = read_seconds;
  return write(sums, options);
}

ExitCode sum_radial(const SumOptions& options) {
  sum::RadialSumRequest request;
  request.function = {*rbf::kernel_named(options.kernel), options.shape.value_or(0)};
  request.method = named("--method", options.method, rbf::methods());
  for (const std::string& text : options.derivatives) request.derivatives.push_back(sum::parse_derivative(text));
  const double read_seconds = read_points(options, request);
  sum::RadialSums sums = sum::sum_radial(request);
  sums.read_seconds = read_seconds;
  return write(sums, options);
}

ExitCode sum(const SumOptions& options) {
  check_table_name(options.out);
  check_options(options);
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
      "sum", "sum Gaussians, radial kernels, Coulomb charges or logarithms over a table of points", declare, sum);
}

}  // namespace gaussdrift::cli
