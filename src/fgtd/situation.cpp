#include "fgtd/situation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "base/parallel.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t sample_size = 2048;  // sources looked at to estimate how many boxes are occupied

/// Cubes of a lattice of unit cubes within `reach` of a random point: the volume of a cube widened by a ball.
double cubes_within(int d, double reach) {
  constexpr double pi = std::numbers::pi;
  constexpr double ball[] = {1, 2, pi, 4 * pi / 3, pi * pi / 2};
  double sum = 0, binomial = 1;
  for (int j = 0; j <= d; ++j) {
    sum += binomial * ball[j] * std::pow(reach, j);
    binomial = binomial * (d - j) / (j + 1);
  }
  return sum;
}

/// Smallest and largest of some numbers.
std::pair<double, double> range_of(const double* x, std::size_t count, int threads) {
  constexpr std::size_t piece = 1 << 15, lanes = 8;
  const std::size_t pieces = (count + piece - 1) / piece;
  std::vector<std::pair<double, double>> range(pieces);
  gaussdrift::base::parallel_for({pieces, 0.5e-9 * static_cast<double>(count)}, threads, [&](std::size_t i) {
    const std::size_t begin = i * piece, end = std::min(count, begin + piece);
    double low[lanes], high[lanes];
    for (std::size_t k = 0; k < lanes; ++k) low[k] = high[k] = x[begin];
    std::size_t j = begin;
    for (; j + lanes <= end; j += lanes)
      for (std::size_t k = 0; k < lanes; ++k) {
        low[k] = x[j + k] < low[k] ? x[j + k] : low[k];
        high[k] = x[j + k] > high[k] ? x[j + k] : high[k];
      }
    for (; j < end; ++j) {
      low[0] = std::min(low[0], x[j]);
      high[0] = std::max(high[0], x[j]);
    }
    range[i] = {*std::min_element(low, low + lanes), *std::max_element(high, high + lanes)};
  });
  for (const auto& [low, high] : range) range[0] = {std::min(range[0].first, low), std::max(range[0].second, high)};
  return range[0];
}

}  // namespace

template <int d>
Situation<d> look_at(const Buffer<double>& position, std::size_t count, std::size_t columns, double sigma,
                     const Options& options) {
  double targets = static_cast<double>(options.expected_targets);
  if (options.expected_grid) targets = static_cast<double>(options.expected_grid->size());
  if (targets == 0) targets = static_cast<double>(count);
  Situation<d> situation{
      options,  sigma, static_cast<double>(count),  targets, static_cast<double>(std::max<std::size_t>(1, columns)),
      position, {},    std::min(count, sample_size)};
  for (std::size_t l = 0; l < d && count > 0; ++l) {
    const double* x = position.data() + l * count;
    const auto [low, high] = range_of(x, count, options.threads);
    situation.low[l] = low;
    situation.extent[l] = high - low;
    for (std::size_t i = 0; i < situation.sample_count; ++i)
      situation.sample.push_back(x[i * count / situation.sample_count]);
  }
  return situation;
}

/// K (1 - exp(-sampled / K)) = seen is solved for K.
double extrapolate(double seen, double sampled, double points) {
  if (sampled >= points) return seen;
  double low = seen, high = 1e18;
  for (int step = 0; step < 100; ++step) {
    const double middle = std::sqrt(low * high);
    (-middle * std::expm1(-sampled / middle) < seen ? low : high) = middle;
  }
  return std::min(points, -high * std::expm1(-points / high));
}

/// Looks at a part of the sample.
template <int d>
double sources_within(const Situation<d>& at, double distance) {
  const std::size_t step = std::max<std::size_t>(1, at.sample_count / 1024),
                    centres = std::min<std::size_t>(at.sample_count, 64);
  std::size_t within = 0, looked_at = 0;
  for (std::size_t c = 0; c < centres; ++c) {
    const std::size_t i = c * at.sample_count / centres;
    for (std::size_t j = 0; j < at.sample_count; j += step) {
      double squared = 0;
      for (std::size_t l = 0; l < d; ++l) {
        const double apart = at.sample[l * at.sample_count + i] - at.sample[l * at.sample_count + j];
        squared += apart * apart;
      }
      within += squared <= distance * distance ? 1 : 0;
      ++looked_at;
    }
  }
  return std::max(1.0, at.sources * static_cast<double>(within) / static_cast<double>(looked_at));
}

template <int d>
double boxes_within(const Situation<d>& at, double side, double reach, double occupied) {
  const double q = reach / side;
  if (!(q < 1e6)) return occupied;
  double cubes = cubes_within(d, q);
  for (std::size_t l = 0; l < d; ++l) {
    const double boxes = std::max(1.0, std::ceil(at.extent[l] / side));
    const double inside = q < boxes ? std::min(boxes, 1 + 2 * q - q * (1 + q) / boxes) : boxes;
    cubes *= inside / (1 + 2 * q);
  }
  return std::min({occupied, std::max(1.0, cubes), sources_within<d>(at, reach + side)});
}

#define FGTD_INSTANTIATE(d)                                                                                  \
  template Situation<d> look_at<d>(const Buffer<double>&, std::size_t, std::size_t, double, const Options&); \
  template double sources_within<d>(const Situation<d>&, double);                                            \
  template double boxes_within<d>(const Situation<d>&, double, double, double);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
