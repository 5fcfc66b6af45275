// Norms of the error of a density.
#pragma once

#include <vector>

#include "gaussdrift/norms.hpp"
#include "reference/sample.hpp"

namespace gaussdrift {

/// Norms of rho - exact over a sample; exact[i] at sample.points[i]. See compare() below.
ErrorNorms compare(const std::vector<double>& rho, const GridSample& sample, const std::vector<double>& exact);

/// Norms of rho - exact over the lattice points where exact is a number, each divided by that of exact; NaN where exact
/// is 0 everywhere. Sums in the order of the points.
ErrorNorms compare(const std::vector<double>& rho, const std::vector<double>& exact);

/// The same, weighted by the areas of the points where these lie on a sphere.
ErrorNorms compare(const Lattice& lattice, const std::vector<double>& rho, const std::vector<double>& exact);

}  // namespace gaussdrift
