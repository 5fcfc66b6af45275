// What a flow does to small differences between particles: its gradient at some of them.
#pragma once

#include <Eigen/Core>
#include <complex>
#include <vector>

#include "field/velocity/differences.hpp"

namespace gaussdrift {

/// Particles at which a gradient is looked at, at most.
constexpr std::size_t sampled_particles = 500;

/// gradient(k, i) = d u_k / d x_i at one place and time.
struct SampledGradient {
  Vector place{};
  double time = 0;
  Eigen::MatrixXd gradient;
};

/// The gradient (differences over `distance`) at up to sampled_particles of the points, at the start, the middle and the
/// end of the time `length`. Points stand where they start. Where a gradient is not finite there is none. `jumps`, if
/// given, gets the places where the velocity jumps.
std::vector<SampledGradient> sampled_gradients(const VelocityField& velocity, const PointsView& points, double length,
                                               double distance, std::vector<Jump>* jumps = nullptr);

/// The same of lengths by lengths (VelocityField::in_lengths). Where coordinates are none, by the field's own formula.
std::vector<SampledGradient> gradients_in_lengths(const VelocityField& velocity, const PointsView& points,
                                                  double length, double distance);

/// The eigenvalues of a square matrix of finite numbers.
std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix);

}  // namespace gaussdrift
