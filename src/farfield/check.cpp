// Refuses bad arguments; see check.hpp.
#include "farfield/check.hpp"

#include <cmath>

#include "farfield/catalogue.hpp"
#include "farfield/images/copies.hpp"

namespace farfield::detail {

void check_options(Kernel kernel, const Options& options, int dimension) {
  const auto refuse = [](const std::string& what) { throw InvalidArgument("farfield: " + what); };
  if (kernel == Kernel::coulomb && dimension == 1) refuse("the kernel coulomb exists in 2 and 3 dimensions, not in 1");
  if (kernel == Kernel::log && dimension == 3) refuse("the kernel log exists in 1 and 2 dimensions, not in 3");
  if (kernel == Kernel::vortex_blob && dimension != 2)
    refuse("the kernel vortex-blob exists in 2 dimensions, not in " + std::to_string(dimension));
  if (kernel == Kernel::vortex_blob && (!(options.core_radius > 0) || !std::isfinite(options.core_radius)))
    refuse("Options::core_radius = " + text(options.core_radius) + ", must be positive and finite for vortex-blob");
  if (kernel != Kernel::vortex_blob && options.core_radius != 0)
    refuse("Options::core_radius = " + text(options.core_radius) + ", must be 0 for every kernel but vortex-blob");
  if (!(options.tolerance > 0) || !(options.tolerance < 1))
    refuse("Options::tolerance = " + text(options.tolerance) + ", must lie in (0, 1)");
  const MethodEntry* const entry = find_entry(options.method);
  if (!entry && options.method != Method::automatic)
    refuse("Options::method = " + std::to_string(static_cast<int>(options.method)) +
           " is no method; farfield::methods() lists them");
  if (entry && entry->replaces_clusters && options.tolerance < smallest_tolerance)
    throw ToleranceError("farfield: Options::tolerance = " + text(options.tolerance) + " cannot be promised by " +
                         to_string(options.method) + ", must be at least " + text(smallest_tolerance) +
                         "; leave the method to auto or direct");
  if (!(options.most_seconds >= 0))
    refuse("Options::most_seconds = " + text(options.most_seconds) + ", must be at least 0");
  if (options.threads < 0)
    refuse("Options::threads = " + std::to_string(options.threads) + ", must be positive, or 0 for all");
  check_axes(options, dimension);
}

void check_points(const char* kind, const double* points, std::size_t dimension, std::size_t count, std::size_t stride,
                  int threads) {
  const auto wrong = gaussdrift::core::point_that_is_not_finite(kind, points, dimension, count, stride, threads);
  if (wrong) throw InvalidArgument("farfield: " + *wrong);
}

void check_charges(const Eigen::Ref<const Eigen::VectorXd>& charges, std::size_t sources) {
  const std::size_t count = static_cast<std::size_t>(charges.size());
  if (count != sources)
    throw InvalidArgument("farfield: there are " + std::to_string(count) + " charges for " + std::to_string(sources) +
                          " sources; there must be one for every source");
  if (gaussdrift::core::all_finite(charges.data(), count, 1, count, 1)) return;
  for (std::size_t j = 0; j < count; ++j) {
    const double value = charges.data()[j];
    if (!std::isfinite(value))
      throw InvalidArgument("farfield: charge " + std::to_string(j) + " is " + text(value) +
                            "; charges must be finite");
  }
}

void check_memory(const char* what, double bytes, std::size_t limit) {
  if (bytes <= static_cast<double>(limit)) return;
  const bool large = limit >= 10'000'000;
  const double unit = large ? 1e6 : 1;
  const std::string name = large ? " MB" : " bytes";
  throw MemoryLimitError("farfield: " + std::string(what) + " would need " + text(std::ceil(bytes / unit)) + name +
                             ", Options::memory_limit allows " + text(std::floor(static_cast<double>(limit) / unit)) +
                             name + "; raise it, or give fewer points",
                         bytes, limit);
}

void check_seconds(Method method, double seconds, double most) {
  if (seconds <= most) return;
  throw TimeLimitError("farfield: " + to_string(method) + " would take about " + text(std::ceil(seconds)) +
                           " s on one thread, Options::most_seconds is " + text(most),
                       seconds, method);
}

void check_values(const char* what, const double* values, std::size_t count, std::size_t numbers_a_target,
                  const std::int64_t* numbers) {
  if (gaussdrift::core::all_finite(values, count * numbers_a_target, 1, count * numbers_a_target, 1)) return;
  for (std::size_t i = 0; i < count * numbers_a_target; ++i) {
    if (std::isfinite(values[i])) continue;
    const std::size_t place = i / numbers_a_target;
    const auto target = numbers ? numbers[place] : static_cast<std::int64_t>(place);
    throw RangeError("farfield: the " + std::string(what) + " at target " + std::to_string(target) +
                         " exceeds the range of double precision; scale the charges down, or join points that are "
                         "nearly equal",
                     what, static_cast<std::size_t>(target));
  }
}

}  // namespace farfield::detail
