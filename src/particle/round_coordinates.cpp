#include "particle/round_coordinates.hpp"

#include <cmath>
#include <map>

namespace gaussdrift {

bool RoundCoordinates::keeps_axes() const { return map[1][0] == 0 && map[2][0] == 0 && map[2][1] == 0; }

Vector RoundCoordinates::of(const Vector& x) const {
  Vector y{};
  for (std::size_t m = 0; m < max_dimension; ++m)
    for (std::size_t k = 0; k <= m; ++k) y[m] += map[m][k] * x[k];
  return y;
}

// width^2 I + longer = L L^T, and the map is the inverse of L.
RoundCoordinates round_coordinates(const CutoffTerm& term) {
  Tensor root{};
  for (std::size_t i = 0; i < max_dimension; ++i)
    for (std::size_t j = 0; j <= i; ++j) {
      double rest = term.longer[i][j] + (i == j ? term.width * term.width : 0);
      for (std::size_t k = 0; k < j; ++k) rest -= root[i][k] * root[j][k];
      root[i][j] = i == j ? std::sqrt(rest) : rest / root[j][j];
    }
  RoundCoordinates round;
  for (std::size_t j = 0; j < max_dimension; ++j) {
    round.map[j][j] = 1 / root[j][j];
    for (std::size_t i = j + 1; i < max_dimension; ++i) {
      double sum = 0;
      for (std::size_t k = j; k < i; ++k) sum += root[i][k] * round.map[k][j];
      round.map[i][j] = -sum / root[i][i];
    }
  }
  return round;
}

// d/dx_k = sum_m map_mk d/dy_m.
std::vector<CutoffTerm> derivative_along(const std::array<int, max_dimension>& derivative,
                                         const RoundCoordinates& coordinates) {
  std::map<std::array<int, max_dimension>, double> sum{{{}, 1.0}};
  for (std::size_t k = 0; k < max_dimension; ++k)
    for (int times = 0; times < derivative[k]; ++times) {
      std::map<std::array<int, max_dimension>, double> next;
      for (const auto& [orders, coefficient] : sum)
        for (std::size_t m = k; m < max_dimension; ++m) {
          if (coordinates.map[m][k] == 0) continue;
          std::array<int, max_dimension> raised = orders;
          ++raised[m];
          next[raised] += coefficient * coordinates.map[m][k];
        }
      sum = std::move(next);
    }
  std::vector<CutoffTerm> terms;
  for (const auto& [orders, coefficient] : sum)
    terms.push_back({.width = 1, .derivative = orders, .coefficient = coefficient});
  return terms;
}

}  // namespace gaussdrift
