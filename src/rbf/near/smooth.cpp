#include "rbf/near/smooth.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace rbf::detail {
namespace {

constexpr int nodes = 32;        // of Chebyshev's polynomials
constexpr int most_powers = 20;  // powers of x lose digits beside Chebyshev's polynomials, a factor of 2.4 each

/// sum_n c_n T_n(x) in powers of x.
std::vector<double> in_powers(const std::vector<long double>& chebyshev) {
  const std::size_t count = chebyshev.size();
  std::vector<long double> before(count), current(count), sum(count);
  current[0] = 1;
  for (std::size_t n = 0; n < count; ++n) {
    for (std::size_t i = 0; i < count; ++i) sum[i] += chebyshev[n] * current[i];
    std::vector<long double> next(count);
    for (std::size_t i = 0; i < count; ++i) next[i] = (i > 0 ? (n == 0 ? 1 : 2) * current[i - 1] : 0) - before[i];
    before = current;
    current = next;
  }
  return {sum.begin(), sum.end()};
}

}  // namespace

bool make_smooth(const Expansion& sum, double radius, int order, double accuracy, Smooth& smooth) {
  std::array<std::vector<long double>, 3> at_nodes;
  for (int i = 0; i < nodes; ++i) {
    const long double x = std::cos(std::numbers::pi_v<long double> * (i + 0.5L) / nodes);
    const Profile profile = sum.profile((x + 1) / 2 * radius * radius);
    at_nodes[0].push_back(profile.value);
    at_nodes[1].push_back(profile.slope);
    at_nodes[2].push_back(profile.curvature);
  }
  const double error[] = {accuracy * sum.scales.of[0],
                          order < 2 ? accuracy * sum.scales.of[1] / (2 * radius)
                                    : accuracy * std::min(sum.scales.of[1] / (2 * radius), sum.scales.of[2] / 4),
                          accuracy * sum.scales.of[2] / (8 * radius * radius)};
  for (std::size_t j = 0; j <= static_cast<std::size_t>(order); ++j) {
    std::vector<long double> chebyshev(nodes);
    for (int n = 0; n < nodes; ++n) {
      for (int i = 0; i < nodes; ++i)
        chebyshev[static_cast<std::size_t>(n)] += at_nodes[j][static_cast<std::size_t>(i)] *
                                                  std::cos(std::numbers::pi_v<long double> * n * (i + 0.5L) / nodes) *
                                                  2 / nodes;
    }
    chebyshev[0] /= 2;
    long double left_out = 0;
    while (chebyshev.size() > 1 && left_out + std::abs(chebyshev.back()) < error[j] / 2) {
      left_out += std::abs(chebyshev.back());
      chebyshev.pop_back();
    }
    if (chebyshev.size() > most_powers) return false;
    chebyshev.resize(chebyshev.size() + chebyshev.size() % 2);  // kernels take pairs
    smooth.coefficients[j] = in_powers(chebyshev);
  }
  return true;
}

}  // namespace rbf::detail
