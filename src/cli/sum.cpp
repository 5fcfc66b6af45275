// gaussdrift sum: tables in, a table out.
#include <fmt/format.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <new>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

#include "base/stopwatch.hpp"
#include "base/suggest.hpp"
#include "cli/verbs.hpp"
#include "input/points_table.hpp"
#include "study/sum_points.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

fgtd::Method method_of(const std::string& name) {
  std::vector<std::string> names;
  for (const fgtd::Method method : fgtd::methods()) {
    names.push_back(fgtd::to_string(method));
    if (names.back() == name) return method;
  }
  const auto meant = base::suggest(name, names);
  throw CommandLineError(fmt::format("--method: there is no \"{}\"{}; there are {}", name,
                                     meant ? fmt::format(", is \"{}\" meant?", *meant) : "", fmt::join(names, ", ")));
}

bool to_standard_output(const SumOptions& options) { return options.out.empty() || options.out == "-"; }

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

void check_options(const SumOptions& options) {
  if (options.kernel != "gauss")
    throw CommandLineError(fmt::format("--kernel: there is no \"{}\"; there is gauss", options.kernel));
  if (!(options.sigma > 0) || !std::isfinite(options.sigma))
    throw CommandLineError(fmt::format("--sigma {}: must be positive and finite", options.sigma));
  if (!(options.tolerance > 0) || !(options.tolerance < 1))
    throw CommandLineError(
        fmt::format("--tolerance {}: must lie in [{}, 1)", options.tolerance, fgtd::smallest_tolerance));
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

void write_file(const study::PointSums& sums, const fs::path& file) {
  Output out(file);
  study::write_table(sums, out.stream());
  out.close();
}

void write_values(const study::PointSums& sums, const SumOptions& options) {
  std::error_code ignored;
  const bool special = fs::exists(options.out, ignored) && !fs::is_regular_file(options.out, ignored);
  try {
    if (to_standard_output(options))
      study::write_table(sums, stdout);
    else if (special)  // a pipe or a device is written to; a rename would replace it
      write_file(sums, options.out);
    else
      write::write_atomically(options.out, [&](const fs::path& part) { write_file(sums, part); });
  } catch (const std::system_error& error) {
    throw FileError(fmt::format("cannot write {}: {}",
                                to_standard_output(options) ? "to standard output" : options.out.string(),
                                error.code().message()));
  }
}

}  // namespace

ExitCode sum(const SumOptions& options) {
  check_options(options);
  study::SumRequest request;
  request.sigma = options.sigma;
  request.tolerance = options.tolerance;
  request.threads = options.threads;
  request.method = method_of(options.method);
  if (!options.grid.empty()) request.grid = study::parse_grid(options.grid);
  for (const std::string& text : options.derivatives) request.derivatives.push_back(study::parse_derivative(text));
  try {
    const base::Stopwatch reading;
    request.sources = input::read_points_table(options.sources, input::PointsRole::sources, request.memory_limit);
    if (!options.targets.empty())
      request.targets = input::read_points_table(options.targets, input::PointsRole::targets, request.memory_limit);
    const double read_seconds = reading.seconds();

    study::PointSums sums = study::sum_points(request);
    sums.read_seconds = read_seconds;
    if (sums.asked != fgtd::Method::automatic && sums.asked != sums.choice.method)
      fmt::print(stderr, "warning: {} is not possible for these points, targets and tolerance; {} did the sum\n",
                 options.method, fgtd::to_string(sums.choice.method));
    const base::Stopwatch writing;
    write_values(sums, options);
    sums.write_seconds = writing.seconds();
    if (options.json)
      fmt::print("{}", study::to_json(sums));
    else if (!to_standard_output(options))
      fmt::print("{}open   {}\n", study::to_text(sums), options.out.string());
  } catch (const std::bad_alloc&) {
    throw InputError("out of memory; ask for fewer targets at a time, or give fewer sources");
  }
  return ExitCode::ok;
}

}  // namespace gaussdrift::cli
