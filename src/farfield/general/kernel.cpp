#include "farfield/general/kernel.hpp"

#include <algorithm>
#include <cmath>

#include "core/arguments.hpp"

namespace farfield {

namespace {

KernelFunction::OfDistance checked(KernelFunction::OfDistance function) {
  if (!function) throw InvalidArgument("farfield: of_distance() needs a function");
  return function;
}

void check_cost(double nanoseconds) {
  if (!(nanoseconds > 0) || !std::isfinite(nanoseconds))
    throw InvalidArgument("farfield: nanoseconds of a kernel = " + gaussdrift::core::text(nanoseconds) +
                          ", must be positive and finite");
}

}  // namespace

using detail::GeneralShape;
using detail::KernelData;

KernelFunction KernelFunction::yukawa(double lambda) {
  if (!(lambda >= 0) || !std::isfinite(lambda))
    throw InvalidArgument("farfield: lambda of yukawa = " + gaussdrift::core::text(lambda) +
                          ", must be >= 0 and finite");
  return KernelFunction(std::make_shared<KernelData>(KernelData{.shape = GeneralShape::yukawa, .parameter = lambda}));
}

KernelFunction KernelFunction::inverse_power(int power) {
  if (power < 1 || power > 12)
    throw InvalidArgument("farfield: power of inverse_power = " + std::to_string(power) + ", must lie in 1 .. 12");
  return KernelFunction(std::make_shared<KernelData>(
      KernelData{.shape = GeneralShape::inverse_power, .parameter = static_cast<double>(power)}));
}

KernelFunction KernelFunction::gaussian(double sigma) {
  if (!(sigma > 0) || !std::isfinite(sigma))
    throw InvalidArgument("farfield: sigma of gaussian = " + gaussdrift::core::text(sigma) +
                          ", must be positive and finite");
  return KernelFunction(std::make_shared<KernelData>(KernelData{.shape = GeneralShape::gaussian, .parameter = sigma}));
}

KernelFunction KernelFunction::of_distance(OfDistance function, double nanoseconds) {
  check_cost(nanoseconds);
  return KernelFunction(std::make_shared<KernelData>(KernelData{
      .shape = GeneralShape::of_distance, .of_distance = checked(std::move(function)), .nanoseconds = nanoseconds}));
}

KernelFunction KernelFunction::of_difference(OfDifference function, double nanoseconds) {
  check_cost(nanoseconds);
  if (!function) throw InvalidArgument("farfield: of_difference() needs a function");
  return KernelFunction(std::make_shared<KernelData>(KernelData{
      .shape = GeneralShape::of_difference, .of_difference = std::move(function), .nanoseconds = nanoseconds}));
}

namespace detail {

void kernel_values(const KernelData& kernel, int dimension, const double* const* difference, std::size_t count,
                   double* values) {
  double distance[kernel_block];
  for (std::size_t i = 0; i < count; ++i)
    distance[i] = dimension == 2 ? std::hypot(difference[0][i], difference[1][i])
                                 : std::hypot(difference[0][i], difference[1][i], difference[2][i]);
  switch (kernel.shape) {
    case GeneralShape::yukawa:
      for (std::size_t i = 0; i < count; ++i) values[i] = std::exp(-kernel.parameter * distance[i]) / distance[i];
      break;
    case GeneralShape::inverse_power:
      for (std::size_t i = 0; i < count; ++i) values[i] = std::pow(distance[i], -kernel.parameter);
      break;
    case GeneralShape::gaussian:
      for (std::size_t i = 0; i < count; ++i) values[i] = std::exp(-kernel.parameter * distance[i] * distance[i]);
      break;
    case GeneralShape::of_distance:
      kernel.of_distance(distance, count, values);
      break;
    case GeneralShape::of_difference:
      kernel.of_difference(difference, count, values);
      break;
  }
  for (std::size_t i = 0; i < count; ++i)
    if (distance[i] == 0 && !std::isfinite(values[i])) values[i] = 0;
}

void add_pairs(const KernelData& kernel, int dimension, const double* const* target, Range targets,
               const double* const* source, const double* charge, const Range* runs, std::size_t run_count,
               double* out) {
  if (kernel.shape != GeneralShape::of_distance && kernel.shape != GeneralShape::of_difference) {
    GeneralPairsJob job{kernel.shape, dimension, kernel.parameter, {}, targets, {}, charge, runs, run_count, out};
    for (int l = 0; l < dimension; ++l) {
      job.target[l] = target[l];
      job.source[l] = source[l];
    }
    fastest_kernels().general_pairs(job);
    return;
  }
  double difference[3][kernel_block], values[kernel_block];
  const double* const rows[3] = {difference[0], difference[1], difference[2]};
  for (std::size_t i = targets.begin; i < targets.end; ++i)
    for (std::size_t run = 0; run < run_count; ++run)
      for (std::size_t begin = runs[run].begin; begin < runs[run].end; begin += kernel_block) {
        const std::size_t count = std::min(kernel_block, runs[run].end - begin);
        for (int l = 0; l < dimension; ++l)
          for (std::size_t j = 0; j < count; ++j) difference[l][j] = target[l][i] - source[l][begin + j];
        kernel_values(kernel, dimension, rows, count, values);
        double sum = 0;
        for (std::size_t j = 0; j < count; ++j) sum += charge[begin + j] * values[j];
        out[i] += sum;
      }
}

}  // namespace detail

}  // namespace farfield
