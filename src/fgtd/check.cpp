// Refuses bad arguments; see check.hpp.
#include "fgtd/check.hpp"

#include <cmath>

#include "fgtd/catalogue.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {

namespace {

std::string text(std::size_t value) { return std::to_string(value); }

}  // namespace

void check_points(const char* kind, const double* points, std::size_t dimension, std::size_t count, std::size_t stride,
                  int threads) {
  const auto wrong = gaussdrift::core::point_that_is_not_finite(kind, points, dimension, count, stride, threads);
  if (wrong) throw InvalidArgument("fgtd: " + *wrong);
}

void check_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights, std::size_t sources, int threads) {
  if (static_cast<std::size_t>(weights.rows()) != sources) {
    throw InvalidArgument("fgtd: weights have " + std::to_string(weights.rows()) + " rows for " + text(sources) +
                          " sources; there must be one row for every source");
  }
  const std::size_t columns = static_cast<std::size_t>(weights.cols());
  if (gaussdrift::core::all_finite(weights.data(), sources, columns, static_cast<std::size_t>(weights.outerStride()),
                                   threads))
    return;
  for (Eigen::Index k = 0; k < weights.cols(); ++k)
    for (Eigen::Index j = 0; j < weights.rows(); ++j)
      if (!std::isfinite(weights(j, k))) {
        throw InvalidArgument("fgtd: weight " + std::to_string(j) + ", column " + std::to_string(k) + " is " +
                              text(weights(j, k)) + "; weights must be finite");
      }
}

void check_sigma(double sigma) {
  if (!(sigma > 0) || !std::isfinite(sigma)) {
    throw InvalidArgument("fgtd: sigma = " + text(sigma) + ", must be positive and finite");
  }
}

void check_options(const Options& options, std::size_t dimension) {
  const double tolerance = options.tolerance;
  if (!(tolerance > 0) || !(tolerance < 1)) {
    throw InvalidArgument("fgtd: Options::tolerance = " + text(tolerance) + ", must lie in [1e-14, 1)");
  }
  if (tolerance < smallest_tolerance) {
    throw ToleranceError("fgtd: Options::tolerance = " + text(tolerance) +
                         " cannot be promised in double precision, must lie in [1e-14, 1)");
  }
  if (options.derivative_order < 0 || options.derivative_order > max_derivative_order) {
    throw InvalidArgument("fgtd: Options::derivative_order = " + std::to_string(options.derivative_order) +
                          ", must lie in 0 .. " + std::to_string(max_derivative_order));
  }
  if (options.derivative_order > any_tolerance_order && tolerance > high_order_tolerance && !options.hermite) {
    throw ToleranceError("fgtd: Options::tolerance = " + text(tolerance) +
                         " cannot be promised for derivatives above order " + std::to_string(any_tolerance_order) +
                         ", must be at most " + text(high_order_tolerance) + " there");
  }
  if (options.method != Method::automatic && !find_entry(options.method)) {
    throw InvalidArgument("fgtd: Options::method = " + std::to_string(static_cast<int>(options.method)) +
                          " is no method; fgtd::methods() lists them");
  }
  if (options.threads < 0) {
    throw InvalidArgument("fgtd: Options::threads = " + std::to_string(options.threads) +
                          ", must be positive, or 0 for all");
  }
  if (!(options.most_seconds >= 0)) {
    throw InvalidArgument("fgtd: Options::most_seconds = " + text(options.most_seconds) + ", must be at least 0");
  }
  if (options.expected_grid) check_grid("Options::expected_grid", *options.expected_grid, dimension);
  if (!options.hermite) return;
  const HermiteParameters& by_hand = *options.hermite;
  if (options.method == Method::direct) {
    throw InvalidArgument(
        "fgtd: Options::hermite is given but Options::method = direct; leave the method to auto or hermite");
  }
  if (!(by_hand.box_scale > 0) || !std::isfinite(by_hand.box_scale)) {
    throw InvalidArgument("fgtd: HermiteParameters::box_scale = " + text(by_hand.box_scale) +
                          ", must be positive and finite");
  }
  if (by_hand.expansion_order < 1 || by_hand.expansion_order > 1000) {
    throw InvalidArgument("fgtd: HermiteParameters::expansion_order = " + std::to_string(by_hand.expansion_order) +
                          ", must lie in 1 .. 1000");
  }
  if (by_hand.neighbours < 0 && by_hand.neighbours != HermiteParameters::all_boxes) {
    throw InvalidArgument("fgtd: HermiteParameters::neighbours = " + std::to_string(by_hand.neighbours) +
                          ", must be at least 0, or all_boxes (-1)");
  }
}

void check_grid(const char* name, const TensorGrid& grid, std::size_t dimension) {
  if (grid.axes.size() != dimension) {
    throw InvalidArgument("fgtd: " + std::string(name) + " has " + text(grid.axes.size()) + " axes, must have " +
                          text(dimension));
  }
  for (std::size_t axis = 0; axis < dimension; ++axis) {
    const auto& nodes = grid.axes[axis];
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      if (!std::isfinite(nodes[i])) {
        throw InvalidArgument("fgtd: " + std::string(name) + ", axis " + text(axis) + ", node " + text(i) + " is " +
                              text(nodes[i]) + "; nodes must be finite");
      }
      if (i > 0 && !(nodes[i - 1] < nodes[i])) {
        throw InvalidArgument("fgtd: " + std::string(name) + ", axis " + text(axis) + ", node " + text(i) + " = " +
                              text(nodes[i]) + " does not exceed the node before it, " + text(nodes[i - 1]) +
                              "; nodes must ascend");
      }
    }
  }
}

void check_memory(const char* what, double bytes, std::size_t limit) {
  if (bytes <= static_cast<double>(limit)) return;
  throw MemoryLimitError("fgtd: " + std::string(what) + " needs about " + text(std::ceil(bytes)) +
                             " bytes, Options::memory_limit is " + text(limit) + " bytes",
                         bytes, limit);
}

void check_seconds(const Choice& choice, double most) {
  if (choice.seconds <= most) return;
  throw TimeLimitError("fgtd: " + to_string(choice.method) + " would take about " + text(std::ceil(choice.seconds)) +
                           " s on one thread, Options::most_seconds is " + text(most),
                       choice.seconds, choice.method);
}

}  // namespace fgtd::detail
