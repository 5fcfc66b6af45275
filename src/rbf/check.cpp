// Refuses bad arguments; see check.hpp.
#include "rbf/check.hpp"

#include <cmath>

#include "rbf/catalogue.hpp"

namespace rbf::detail {
namespace {

[[noreturn]] void refuse(const std::string& what) { throw InvalidArgument("rbf: " + what); }

// Squares of lengths beyond are no doubles, or their inverses are not.
constexpr double shortest = 1e-75, longest = 1e75;

}  // namespace

void check_function(const Function& function) {
  const KernelEntry& entry = entry_of(function.kernel);
  const std::string shape = "shape = " + text(function.shape);
  if (!entry.takes_shape) {
    if (function.shape != 0) refuse(shape + ", must be 0 for " + entry.name + ", which has no shape");
    return;
  }
  if (!(function.shape > 0) || !std::isfinite(function.shape))
    refuse(shape + ", must be positive and finite for " + entry.name +
           ": a length, of about the distance between neighbouring centres or a few times that");
  if (function.shape < shortest || function.shape > longest)
    refuse(shape + ", must lie in [" + text(shortest) + ", " + text(longest) + "]; take another unit of length");
}

void check_options(const Function& function, const Options& options) {
  const KernelEntry& entry = entry_of(function.kernel);
  if (!(options.tolerance > 0) || !(options.tolerance < 1))
    refuse("Options::tolerance = " + text(options.tolerance) + ", must lie in (0, 1)");
  if (options.method == Method::gaussians && options.tolerance < smallest_tolerance)
    throw ToleranceError("rbf: Options::tolerance = " + text(options.tolerance) +
                         " cannot be promised by gaussians, must be at least " + text(smallest_tolerance) +
                         "; leave the method to auto or direct");
  if (options.derivative_order < 0 || options.derivative_order > entry.highest_derivative)
    refuse("Options::derivative_order = " + std::to_string(options.derivative_order) + ", must lie in 0 .. " +
           std::to_string(entry.highest_derivative) + " for " + entry.name +
           (entry.highest_derivative < 2 ? ", whose second derivatives are infinite at distance 0" : ""));
  bool known = false;
  for (const Method method : methods()) known = known || method == options.method;
  if (!known)
    refuse("Options::method = " + std::to_string(static_cast<int>(options.method)) +
           " is no method; rbf::methods() lists them");
  if (options.threads < 0)
    refuse("Options::threads = " + std::to_string(options.threads) + ", must be positive, or 0 for all");
  if (!(options.most_seconds >= 0))
    refuse("Options::most_seconds = " + text(options.most_seconds) + ", must be at least 0");
  if (!(options.range >= 0) || options.range > longest || (options.range > 0 && options.range < shortest))
    refuse("Options::range = " + text(options.range) + ", must be 0 or lie in [" + text(shortest) + ", " +
           text(longest) + "]");
}

void check_points(const char* kind, const double* points, std::size_t dimension, std::size_t count, std::size_t stride,
                  int threads) {
  const auto wrong = gaussdrift::core::point_that_is_not_finite(kind, points, dimension, count, stride, threads);
  if (wrong) refuse(*wrong);
}

void check_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights, std::size_t centres, int threads) {
  const std::size_t rows = static_cast<std::size_t>(weights.rows()), columns = static_cast<std::size_t>(weights.cols());
  if (rows != centres)
    refuse("there are " + std::to_string(centres) + " centres but " + std::to_string(rows) +
           " rows of weights; every centre needs one");
  if (gaussdrift::core::all_finite(weights.data(), rows, columns, static_cast<std::size_t>(weights.outerStride()),
                                   threads))
    return;
  for (Eigen::Index k = 0; k < weights.cols(); ++k)
    for (Eigen::Index j = 0; j < weights.rows(); ++j)
      if (!std::isfinite(weights(j, k)))
        refuse("weight " + std::to_string(j) + ", column " + std::to_string(k) + " is " + text(weights(j, k)) +
               "; weights must be finite");
}

void check_grid(const char* name, const TensorGrid& grid, std::size_t dimension) {
  if (grid.axes.size() != dimension)
    refuse(std::string(name) + " has " + std::to_string(grid.axes.size()) + " axes, must have " +
           std::to_string(dimension));
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const std::vector<double>& nodes = grid.axes[axis];
    for (std::size_t i = 0; i < nodes.size(); ++i)
      if (!std::isfinite(nodes[i]) || (i > 0 && !(nodes[i - 1] < nodes[i])))
        refuse(std::string(name) + ", axis " + std::to_string(axis) + ", node " + std::to_string(i) + " is " +
               text(nodes[i]) + "; nodes must be finite and ascend");
  }
}

void check_seconds(Method method, double seconds, double most) {
  if (seconds <= most) return;
  throw TimeLimitError("rbf: " + to_string(method) + " would take about " + text(std::ceil(seconds)) +
                           " s on one thread, Options::most_seconds is " + text(most),
                       seconds, method);
}

void check_memory(const char* what, double bytes, std::size_t limit) {
  if (bytes <= static_cast<double>(limit)) return;
  throw MemoryLimitError("rbf: " + std::string(what) + " needs about " + text(std::ceil(bytes)) +
                             " bytes, Options::memory_limit is " + std::to_string(limit) + " bytes",
                         bytes, limit);
}

}  // namespace rbf::detail
