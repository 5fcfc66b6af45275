// The definition itself, every source at every target: the oracle of all other methods, and the fastest for few points.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fgtd/fgtd.hpp"
#include "fgtd/request.hpp"

namespace fgtd::detail {

/// Sources as the sums need them: one array an axis, one array a column of weights.
template <int d>
struct Sources {
  std::size_t count = 0;
  std::size_t columns = 0;
  std::vector<double> position;  // [d][count]
  std::vector<double> weights;   // [columns][count]
};

/// values[(q columns + k) targets + i]; targets [targets][d].
template <int d>
void evaluate_direct(const Sources<d>& sources, double sigma, const Request<d>& request, const double* targets,
                     std::size_t count, int threads, double* values);

/// The same on a tensor grid, first axis fastest.
template <int d>
void evaluate_direct(const Sources<d>& sources, double sigma, const Request<d>& request, const TensorGrid& grid,
                     int threads, double* values);

}  // namespace fgtd::detail
