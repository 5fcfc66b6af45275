#include "field/velocity/streamfunction_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "field/velocity/in_blocks.hpp"

namespace gaussdrift {

StreamfunctionField::StreamfunctionField(const std::string& psi,
                                         const std::vector<std::pair<std::string, double>>& params, double length)
    : psi_(psi, {"x", "y", "t"}, params), length_(length) {}

void StreamfunctionField::add(double t, const PointsView& x, const VectorsView& u) const {
  std::array<double, block_length> dx, dy;
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    double* const slopes[] = {dx.data(), dy.data()};
    psi_.differentiate(arguments, length, {0, 1}, nullptr, slopes);
    for (std::size_t i = 0; i < length; ++i) {
      u.axis[0][first + i] += dy[i];
      u.axis[1][first + i] -= dx[i];
    }
  });
}

void StreamfunctionField::add_divergence(double /*t*/, const PointsView& /*x*/, double* /*values*/) const {}

// u = (psi_y, -psi_x), so the gradient has psi's second derivatives. The difference of psi_xy and psi_yx is rounding; the
// divergence is 0 with the one taken for both.
void StreamfunctionField::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  const double h = length_ / 1024;
  constexpr std::array<double, 3> weight{45, -9, 1};  // of +-h, +-2h, +-3h; over 60 h
  std::array<double, block_length> dx, dy;
  double* const slopes[] = {dx.data(), dy.data()};
  std::array<std::array<double, block_length>, 2> place;
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    std::array<const double*, 3> shifted{place[0].data(), place[1].data(), arguments[2]};
    for (std::size_t axis = 0; axis < 2; ++axis)
      for (std::size_t far = 1; far <= weight.size(); ++far)
        for (const int side : {-1, 1}) {
          for (std::size_t k = 0; k < 2; ++k) std::copy_n(arguments[k], length, place[k].data());
          for (std::size_t i = 0; i < length; ++i) place[axis][i] += side * static_cast<double>(far) * h;
          psi_.differentiate(shifted.data(), length, {0, 1}, nullptr, slopes);
          const double factor = side * weight[far - 1] / (60 * h);
          for (std::size_t i = 0; i < length; ++i) {
            const std::size_t j = first + i;
            gradients.slope[axis == 0 ? 1 : 0][axis][j] += axis == 0 ? -factor * dx[i] : factor * dy[i];
            if (axis == 0) {
              gradients.slope[0][0][j] += factor * dy[i];
              gradients.slope[1][1][j] -= factor * dy[i];
            }
          }
        }
  });
}

bool StreamfunctionField::is_steady() const { return !psi_.uses("t"); }

bool StreamfunctionField::is_smooth() const { return psi_.rough_spots().empty(); }

double StreamfunctionField::cost() const { return std::max(1.0, 3 * psi_.cost()); }  // with two derivatives

std::string StreamfunctionField::describe() const {
  return fmt::format("u = (d psi/dy, -d psi/dx), psi = {}, div u = 0", psi_.text());
}

}  // namespace gaussdrift
