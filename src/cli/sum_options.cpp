#include "cli/sum_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <system_error>

#include "base/suggest.hpp"
#include "cli/asked_case.hpp"
#include "cli/output_name.hpp"
#include "cli/sum_output.hpp"
#include "fgtd/fgtd.hpp"
#include "gaussdrift/error.hpp"
#include "input/points_table.hpp"
#include "rbf/rbf.hpp"
#include "sum/general.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> radial_names() {
  std::vector<std::string> names;
  for (const rbf::Kernel kernel : rbf::kernels()) names.push_back(to_string(kernel));
  return names;
}

}  // namespace

void declare_sum(OptionList& options, SumOptions& given) {
  options
      .add("--sources", given.sources, "FILE",
           "table of sources: coordinates and a column weight. Text, .npy or .vtp; - is standard input")
      .required();
  const Option targets = options.add("--targets", given.targets, "FILE", "table of targets. By default the sources");
  options.add("--columns", given.columns, "NAME,...",
              "the columns that are coordinates, by name or by number: --columns x,y or --columns 1,2. By default all "
              "but the weight");
  options.add("--weight", given.weight, "NAME", "the column of the weights, by name or by number; weight by default");
  options
      .add("--grid", given.grid, "LOW:HIGH:COUNT,...",
           "a grid of targets: --grid=-1:1:200,0:1:100. Its first axis runs fastest")
      .excludes(targets);
  const Option sigma = options.add("--sigma", given.sigma, "X", "of the Gaussian exp(-sigma r^2)");
  options
      .add("--bandwidth", given.bandwidth, "B",
           "in place of --sigma, how wide the Gaussian is: a standard deviation as 0.2, a covariance row by row as "
           "1,0.5,0.5,1, or a rule that looks at the points: scott or silverman")
      .excludes(sigma);
  options.flag(
      "--normalise", given.normalise,
      "the sum becomes a density with the integral 1 (kernel density estimation): weights are divided by their "
      "sum, and the Gaussian by its integral. No column of weights is needed. --bandwidth is scott by default");
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
  options.add(
      "--out", given.out, "FILE",
      "file for the values: a table, a .npy for NumPy, or of a grid a .vti for ParaView. By default, or as -, a "
      "table on standard output");
  declare_memory(options, given.memory);
  options.threads(given.threads);
  options.json(given.json, "what was chosen and what it cost, as JSON on standard output. Needs --out");
}

bool by_hand(const SumOptions& options) { return options.r || options.p || !options.n.empty(); }

std::string bandwidth_of(const SumOptions& options) {
  return options.bandwidth.empty() && !options.sigma && options.normalise ? "scott" : options.bandwidth;
}

double tolerance_of(const SumOptions& options) { return options.tolerance.value_or(1e-6); }

bool of_pairs(const SumOptions& options) { return options.kernel == "coulomb" || options.kernel == "log"; }

bool of_expression(const SumOptions& options) { return sum::is_kernel_expression(options.kernel); }

bool to_standard_output(const SumOptions& options) { return options.out.empty() || options.out == "-"; }

bool of_radial(const SumOptions& options) { return rbf::kernel_named(options.kernel).has_value(); }

namespace {

bool same_file(const fs::path& a, const fs::path& b) {
  std::error_code ignored;
  return fs::equivalent(a, b, ignored);
}

/// Values on a grid alone make an image.
void check_ending(const SumOptions& options) {
  if (format_of(options.out) != ValuesFormat::image) return;
  constexpr std::size_t most_axes = 3;
  const std::size_t axes = options.grid.empty() ? 0 : sum::parse_grid(options.grid).size();
  if (axes > most_axes)
    throw CommandLineError(fmt::format("--out {}: an image has 1 to {} axes, the grid {}; give a name such as {}",
                                       options.out.string(), most_axes, axes,
                                       fs::path(options.out).replace_extension(".npy").string()));
  if (axes == 0)
    throw CommandLineError(fmt::format("--out {}: an image has values on a grid; give --grid, or a name such as {}",
                                       options.out.string(), fs::path(options.out).replace_extension(".npy").string()));
}

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
  if (options.normalise || !options.bandwidth.empty())
    throw CommandLineError(fmt::format("{} belongs to the kernel gauss, not to {}",
                                       options.normalise ? "--normalise" : "--bandwidth", options.kernel));
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
  if (!options.sigma && bandwidth_of(options).empty())
    throw CommandLineError(
        "--sigma is missing: the Gaussian is exp(-sigma r^2). Or give --bandwidth, its standard deviation");
  if (options.sigma && (!(*options.sigma > 0) || !std::isfinite(*options.sigma)))
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

}  // namespace

void check_sum_options(const SumOptions& options) {
  if (options.kernel == "gauss") {
    check_shape(options);
    check_gauss(options);
  } else if (of_pairs(options) || of_expression(options) || of_radial(options)) {
    check_not_of_gauss(options);
    check_shape(options);
  } else {
    refuse_kernel(options.kernel);
  }
  if (options.sources == input::standard_input && options.targets == input::standard_input)
    throw CommandLineError("--sources and --targets cannot both be -, standard input; give one of them as a file");
  if (options.seconds && !(*options.seconds > 0))
    throw CommandLineError(fmt::format("--seconds {}: must be positive", *options.seconds));
  if (to_standard_output(options)) {
    if (options.json)
      throw CommandLineError("--json writes to standard output, so the values need a file; add --out FILE");
    return;
  }
  check_ending(options);
  for (const fs::path& input : {options.sources, options.targets})
    if (!input.empty() && input != input::standard_input && same_file(input, options.out))
      throw CommandLineError(fmt::format("--out {} would replace a table that is read", options.out.string()));
  std::error_code ignored;
  if (fs::is_directory(options.out, ignored))
    throw FileError(fmt::format("cannot write {}: it is a folder; name a file with --out", options.out.string()));
}

}  // namespace gaussdrift::cli
