// How much weight can lie near one place. It turns the promise of fgtd about single Gaussians into one about their
// sum.
#pragma once

#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// An upper bound for the weight sum_{|x_j - y| < reach} |weight_j| over all y, from box sums; weight [points.count].
/// Throws NumericalError if the points lie so far apart that no number can hold their distance.
double largest_weight_within(const PointsView& points, const double* weight, double reach);

}  // namespace gaussdrift
