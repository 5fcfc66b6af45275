#include "reference/lost_velocity.hpp"

#include <cmath>

namespace gaussdrift {

std::string why_path_ends(const VelocityField& velocity, double t, int dimension, Vector x, double ahead) {
  std::string reason = velocity.why_not_finite(t, x);
  if (!reason.empty()) return reason;
  Vector u{};
  PointsView here{dimension, 1, {}};
  VectorsView there{dimension, 1, {}};
  for (int k = 0; k < dimension; ++k) here.axis[k] = &x[k], there.axis[k] = &u[k];
  velocity.add(t, here, there);
  const double speed = std::sqrt(u[0] * u[0] + u[1] * u[1] + u[2] * u[2]);
  if (!(speed > 0 && std::isfinite(speed))) return "";
  for (int k = 0; k < dimension; ++k) x[k] += ahead * u[k] / speed;
  return velocity.why_not_finite(t, x);
}

}  // namespace gaussdrift
