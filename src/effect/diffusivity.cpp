#include "effect/diffusivity.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Eigenvalues>
#include <array>
#include <cmath>
#include <string_view>
#include <vector>

#include "gaussdrift/error.hpp"

namespace gaussdrift {

std::optional<Tensor> constant_diffusivity(const EffectSpec& effect, int dimension) {
  Tensor matrix{};
  const auto axes = static_cast<std::size_t>(dimension);
  if (effect.has("D")) {
    for (std::size_t k = 0; k < axes; ++k) matrix[k][k] = effect.number("D");
    return matrix;
  }
  if (!effect.has("D_axes")) return std::nullopt;
  for (std::size_t k = 0; k < axes; ++k) matrix[k][k] = effect.point("D_axes").at(k);
  for (std::size_t k = 0; k < axes; ++k)
    for (std::size_t l = k + 1; l < axes; ++l)
      if (const std::string key = fmt::format("D_{}{}", "xyz"[k], "xyz"[l]); effect.has(key))
        matrix[k][l] = matrix[l][k] = effect.number(key);
  return matrix;
}

PrincipalValues principal_values(const Tensor& diffusivity, int dimension) {
  Eigen::MatrixXd matrix(dimension, dimension);
  for (int i = 0; i < dimension; ++i)
    for (int j = 0; j < dimension; ++j)
      matrix(i, j) = diffusivity[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)];
  const Eigen::VectorXd values = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues();
  return {values.minCoeff(), values.maxCoeff()};
}

std::string words_of_tensor(const Tensor& diffusivity) {
  const std::size_t axes = diffusivity[2][2] == 0 && diffusivity[2][0] == 0 && diffusivity[2][1] == 0 ? 2 : 3;
  Tensor same{};
  for (std::size_t k = 0; k < axes; ++k) same[k][k] = diffusivity[0][0];
  if (diffusivity == same) return fmt::format("{:g}", diffusivity[0][0]);
  std::vector<std::string> rows;
  for (std::size_t k = 0; k < axes; ++k) {
    std::vector<std::string> row;
    for (std::size_t l = 0; l < axes; ++l) row.push_back(fmt::format("{:g}", diffusivity[k][l]));
    rows.push_back(fmt::format("[{}]", fmt::join(row, ", ")));
  }
  return fmt::format("[{}]", fmt::join(rows, ", "));
}

void check_diffusivity(const PointsView& x, const double* values, const std::int64_t* id, double time) {
  for (std::size_t i = 0; i < x.count; ++i) {
    if (values[i] >= 0 && std::isfinite(values[i])) continue;
    std::string place;
    for (int k = 0; k < x.dimension; ++k) place += fmt::format("{}{:.6g}", k ? ", " : "", x.axis[k][i]);
    const std::string value = std::isnan(values[i]) ? "not a number" : fmt::format("{:.6g}", values[i]);
    throw NumericalError(
        fmt::format("the coefficient of [effects.diffusion] is {} at t = {:.6g} at ({}), where particle {} comes. It "
                    "must be 0 or a positive number wherever particles go: guard the expression, as by max(0, ...), "
                    "let file say more with outside = \"clamp\", or shorten time.end.",
                    value, time, place, id[i]));
  }
}

}  // namespace gaussdrift
