// gaussdrift fit: a function through scattered values, on a grid.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "accuracy/memory_limits.hpp"
#include "base/printed.hpp"
#include "base/suggest.hpp"
#include "cli/asked_case.hpp"
#include "cli/laid_out.hpp"
#include "cli/output_name.hpp"
#include "cli/terminal.hpp"
#include "cli/verbs.hpp"
#include "gaussdrift/density_grid.hpp"
#include "gaussdrift/error.hpp"
#include "input/points_table.hpp"
#include "rbf/integral.hpp"
#include "rbf/interpolant.hpp"
#include "write/atomic_file.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

struct FitVerbOptions {
  fs::path data;
  std::string value = "rho";
  std::string kernel = "thin-plate";
  double shape = 0;  // 0: chosen
  std::string shape_by;
  double regularisation = 0;
  int per_axis = 200;
  fs::path out;
  std::string memory;
  int threads = 0;
  bool json = false;
};

std::vector<std::string> kernel_names() {
  std::vector<std::string> names;
  for (const rbf::Kernel kernel : rbf::kernels()) names.push_back(to_string(kernel));
  return names;
}

void declare(OptionList& options, FitVerbOptions& given) {
  options.add("data", given.data, "DATA", "table (CSV) with columns x, y, perhaps z, and a value").required();
  options.add("--value", given.value, "NAME", "the column of the values; rho by default");
  options
      .add("--kernel", given.kernel, "NAME", fmt::format("{}; thin-plate by default", fmt::join(kernel_names(), ", ")))
      .offers(kernel_names);
  const Option shape =
      options.add("--shape", given.shape, "C", "of the kernel, a length; by default it is chosen").not_negative();
  options
      .add("--shape-by", given.shape_by, "WHAT",
           "how it is chosen: left-out, by the errors of left-out values, which is the default; or likelihood, by that "
           "of "
           "the values as a Gaussian process")
      .excludes(shape);
  options
      .add("--regularisation", given.regularisation, "X",
           "added to the diagonal of the equations: the fit is smoother and only near the values; 0 by default")
      .not_negative();
  options.add("--grid", given.per_axis, "N", "points on the longest side of the box around the data; 200 by default")
      .within(2, 100000);
  options.add("--out", given.out, "FILE", "the grid, a .vti: value, gradient, error").required();
  declare_memory(options, given.memory);
  options.threads(given.threads);
  options.json(given.json);
}

rbf::Kernel kernel_of(const std::string& name) {
  if (const auto kernel = rbf::kernel_named(name)) return *kernel;
  const std::vector<std::string> names = kernel_names();
  const auto near = base::suggest(name, names);
  throw CommandLineError(fmt::format("--kernel {}: there is no such kernel{}; there are {}", name,
                                     near ? fmt::format(", is \"{}\" meant?", *near) : "", fmt::join(names, ", ")));
}

rbf::ShapeBy shape_by(const FitVerbOptions& options) {
  if (options.shape_by.empty()) return rbf::ShapeBy::left_out;
  if (const rbf::Kernel kernel = kernel_of(options.kernel); !rbf::takes_shape(kernel))
    throw CommandLineError(
        fmt::format("--shape-by {}: {} has no shape; leave it out", options.shape_by, to_string(kernel)));
  std::vector<std::string> names;
  for (const rbf::ShapeBy by : rbf::ways_to_choose_a_shape()) {
    if (to_string(by) == options.shape_by) return by;
    names.push_back(to_string(by));
  }
  throw CommandLineError(
      fmt::format("--shape-by {}: there is no such way; there are {}", options.shape_by, fmt::join(names, ", ")));
}

struct Data {
  int dimension = 2;
  std::vector<double> rows;  // [point][x, y, (z,) value]
  std::size_t size() const { return rows.size() / static_cast<std::size_t>(dimension + 1); }
};

/// Root mean squares of the left-out errors around grid points: weighted by Gaussians of twice the spacing of the data. NaN
/// where no data are near.
template <int d>
std::vector<double> error_near(const rbf::Interpolant<d>& fit, const fgtd::TensorGrid& grid, int threads) {
  Eigen::MatrixXd weights(fit.points().cols(), 2);
  weights.col(0) = fit.left_out_errors().col(0).array().square();
  weights.col(1).setOnes();
  const double width = 2 * fit.report().spacing;
  const fgtd::Plan<d> plan(fit.points(), weights, 1 / (width * width),
                           {.tolerance = 1e-6, .threads = threads, .expected_grid = grid});
  const Eigen::MatrixXd sums = plan.evaluate(grid);
  std::vector<double> errors(static_cast<std::size_t>(sums.rows()));
  constexpr double near = 1e-3;  // of one point: within five spacings of the data
  for (Eigen::Index i = 0; i < sums.rows(); ++i)
    errors[static_cast<std::size_t>(i)] = sums(i, 1) > near ? std::sqrt(std::max(0.0, sums(i, 0) / sums(i, 1))) : NAN;
  return errors;
}

struct Result {
  Lattice lattice;
  std::vector<FieldOnGrid> fields;
  rbf::FitReport report;
  double integral = 0;
};

template <int d>
Result fit_in(const Data& data, const FitVerbOptions& options, std::size_t memory) {
  const auto count = static_cast<Eigen::Index>(data.size());
  const Eigen::Map<const Eigen::MatrixXd> rows(data.rows.data(), d + 1, count);
  const rbf::Points<d> points = rows.template topRows<d>();
  const Eigen::MatrixXd values = rows.row(d).transpose();
  const rbf::Interpolant<d> fit({kernel_of(options.kernel), options.shape}, points, values,
                                {.regularisation = options.regularisation,
                                 .shape_by = shape_by(options),
                                 .threads = options.threads,
                                 .memory_limit = memory});
  Result result;
  result.report = fit.report();
  const Eigen::Matrix<double, d, 1> low = points.rowwise().minCoeff(), high = points.rowwise().maxCoeff();
  Vector min{}, max{};
  for (int k = 0; k < d; ++k) min[static_cast<std::size_t>(k)] = low(k), max[static_cast<std::size_t>(k)] = high(k);
  result.lattice = make_lattice(d, min, max, options.per_axis);
  rbf::TensorGrid grid;
  for (int k = 0; k < d; ++k) {
    auto& axis = grid.axes.emplace_back();
    for (std::size_t i = 0; i < result.lattice.points[static_cast<std::size_t>(k)]; ++i)
      axis.push_back(result.lattice.coordinate(k, i));
  }
  std::vector<rbf::Combination<d>> wanted{{{{}, 1.0}}};
  for (std::size_t k = 0; k < d; ++k) {
    rbf::Derivative<d> along{};
    along[k] = 1;
    wanted.push_back({{along, 1.0}});
  }
  const Eigen::MatrixXd sums = fit.evaluate_combinations(grid, wanted);
  FieldOnGrid value{options.value, 1, {}}, gradient{"gradient", d, {}};
  for (Eigen::Index i = 0; i < sums.rows(); ++i) {
    value.values.push_back(sums(i, 0));
    for (int k = 0; k < d; ++k) gradient.values.push_back(sums(i, 1 + k));
  }
  result.fields = {std::move(value), std::move(gradient), {"error", 1, error_near<d>(fit, grid, options.threads)}};
  result.integral = rbf::integral<d>(fit, low, high).values(0);
  return result;
}

ExitCode fit(const FitVerbOptions& options) {
  if (options.out.extension() != ".vti")
    throw CommandLineError(
        fmt::format("--out {}: the grid is written as image data for ParaView; give a name such as {}",
                    options.out.string(), fs::path(options.out).replace_extension(".vti").string()));
  if (options.value == "gradient" || options.value == "error")
    throw CommandLineError(
        fmt::format("--value {}: the file has an array of that name beside the value", options.value));
  kernel_of(options.kernel);
  shape_by(options);
  const double left = 0.9 * accuracy::tightest_limit(most_memory(options.memory)).left();
  const auto memory = static_cast<std::size_t>(std::clamp(left, 0.0, 8e9));
  Data data{.dimension = input::has_third_coordinate(options.data, memory) ? 3 : 2, .rows = {}};
  std::vector<std::string> names{"x", "y", "z"};
  names.resize(static_cast<std::size_t>(data.dimension));
  names.push_back(options.value);
  data.rows = input::read_named_columns(options.data, names, memory).rows;
  Result result;
  try {
    result = data.dimension == 2 ? fit_in<2>(data, options, memory) : fit_in<3>(data, options, memory);
  } catch (const rbf::Error& error) {
    throw InputError(fmt::format("{}: {}", options.data.string(), error.what()));
  }
  write::write_text(options.out, write::fields_text(options.out, result.lattice, result.fields, 0));
  const rbf::FitReport& report = result.report;
  if (options.json) {
    say("{}\n",
        laid_out({{"points", report.points},
                  {"kernel", to_string(report.function.kernel)},
                  {"shape", report.function.shape},
                  {"log_likelihood", report.log_likelihood.empty() ? nlohmann::ordered_json()
                                                                   : nlohmann::ordered_json(report.log_likelihood[0])},
                  {"solver", to_string(report.solver)},
                  {"residual", report.residual},
                  {"condition", report.condition},
                  {"iterations", report.iterations},
                  {"left_out_error", report.left_out[0]},
                  {"values", report.values[0]},
                  {"integral", result.integral},
                  {"seconds", report.seconds},
                  {"file", options.out.string()}}));
    return ExitCode::ok;
  }
  say("fit    {}\n", base::printed(report));
  say("total  {:.9g}, the integral over the box of the data\n", result.integral);
  say("open   {} in ParaView: {}, gradient, error (estimated there)\n", options.out.string(), options.value);
  return ExitCode::ok;
}

}  // namespace

Verb fit_verb() {
  return make_verb<FitVerbOptions>("fit", "fit a function to scattered values and write it on a grid", declare, fit);
}

}  // namespace gaussdrift::cli
