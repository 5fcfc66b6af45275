// Particles as points of fgtd.
#pragma once

#include "fgtd/fgtd.hpp"
#include "gaussdrift/particles.hpp"

namespace gaussdrift {

/// All places, one column for each particle.
template <int d>
fgtd::Points<d> points_of(const Particles& particles) {
  fgtd::Points<d> points(d, static_cast<Eigen::Index>(particles.size()));
  for (int k = 0; k < d; ++k)
    points.row(k) = Eigen::Map<const Eigen::RowVectorXd>(particles.position[k].data(), points.cols());
  return points;
}

}  // namespace gaussdrift
