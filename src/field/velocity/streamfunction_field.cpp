#include "field/velocity/streamfunction_field.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "field/velocity/in_blocks.hpp"

namespace gaussdrift {

StreamfunctionField::StreamfunctionField(const std::string& psi,
                                         const std::vector<std::pair<std::string, double>>& params)
    : psi_(psi, {"x", "y", "t"}, params) {}

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

bool StreamfunctionField::is_steady() const { return !psi_.uses("t"); }

bool StreamfunctionField::is_smooth() const { return psi_.rough_spots().empty(); }

double StreamfunctionField::cost() const { return std::max(1.0, 3 * psi_.cost()); }  // with two derivatives

std::string StreamfunctionField::describe() const {
  return fmt::format("u = (d psi/dy, -d psi/dx), psi = {}, div u = 0", psi_.text());
}

}  // namespace gaussdrift
