#include "field/velocity/sampled_gradients.hpp"

#include <Eigen/Eigenvalues>

namespace gaussdrift {

std::vector<SampledGradient> sampled_gradients(const VelocityField& velocity, const PointsView& points, double length,
                                               double distance, std::vector<Jump>* jumps) {
  std::vector<SampledGradient> samples;
  const int dimension = points.dimension;
  const Columns x = sample_of(points, sampled_particles);
  for (const double t : {0.0, 0.5 * length, length}) {
    const auto gradient = gradient_by_differences(velocity, t, x, dimension, distance, jumps);
    for (std::size_t j = 0; j < x[0].size(); ++j) {
      SampledGradient sample{{}, t, Eigen::MatrixXd(dimension, dimension)};
      for (int k = 0; k < dimension; ++k) {
        sample.place[k] = x[k][j];
        for (int i = 0; i < dimension; ++i) sample.gradient(k, i) = gradient[k][i][j];
      }
      if (sample.gradient.allFinite()) samples.push_back(std::move(sample));
    }
  }
  return samples;
}

std::vector<SampledGradient> gradients_in_lengths(const VelocityField& velocity, const PointsView& points,
                                                  double length, double distance) {
  const VelocityField& in_lengths = velocity.in_lengths();
  if (&in_lengths == &velocity) return sampled_gradients(velocity, points, length, distance);
  std::vector<SampledGradient> samples;
  const auto dimension = static_cast<std::size_t>(points.dimension);
  const Columns x = sample_of(points, sampled_particles);
  PointsView places{points.dimension, x[0].size(), {}};
  for (std::size_t k = 0; k < dimension; ++k) places.axis[k] = x[k].data();
  for (const double t : {0.0, 0.5 * length, length}) {
    std::vector<double> slopes(dimension * dimension * places.count, 0.0);
    GradientsView gradient{points.dimension, places.count, {}};
    for (std::size_t n = 0; n < dimension * dimension; ++n)
      gradient.slope[n / dimension][n % dimension] = slopes.data() + n * places.count;
    in_lengths.add_gradient(t, places, gradient);
    for (std::size_t j = 0; j < places.count; ++j) {
      SampledGradient sample{places.at(j), t, Eigen::MatrixXd(dimension, dimension)};
      for (std::size_t n = 0; n < dimension * dimension; ++n)
        sample.gradient(static_cast<Eigen::Index>(n / dimension), static_cast<Eigen::Index>(n % dimension)) =
            slopes[n * places.count + j];
      if (sample.gradient.allFinite()) samples.push_back(std::move(sample));
    }
  }
  return samples;
}

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXcd values = matrix.eigenvalues();
  return {values.begin(), values.end()};
}

}  // namespace gaussdrift
