// Flexible GMRES [Saa93]: for preconditioners that are not the same matrix every time, as sums to a tolerance make them.
#pragma once

#include <functional>

#include "rbf/fit/dense_system.hpp"

namespace rbf::detail {

/// From values to coefficients, and back.
struct Operators {
  std::function<Coefficients(const Eigen::VectorXd&)> preconditioner;
  std::function<Eigen::VectorXd(const Coefficients&)> product;
};

/// Coefficients the product of which is `values`, up to an error of `factor` times their Euclidean norm or as near as
/// `most_iterations` come. Takes 2 most_iterations vectors of memory.
/// @param iterations  is raised by those that were made
Coefficients flexible_gmres(const Operators& operators, const Eigen::VectorXd& values, double factor,
                            int most_iterations, int& iterations);

}  // namespace rbf::detail
