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

std::vector<std::complex<double>> eigenvalues_of(const Eigen::MatrixXd& matrix) {
  const Eigen::VectorXcd values = matrix.eigenvalues();
  return {values.begin(), values.end()};
}

}  // namespace gaussdrift
