// Points, targets and results between Eigen and the sums.
#pragma once

#include <algorithm>
#include <cstddef>

#include "base/parallel.hpp"
#include "core/buffer.hpp"
#include "fgtd/fgtd.hpp"

namespace fgtd::detail {

/// Numbers from one point to the next. One-dimensional points are a row, which Eigen keeps row-major.
template <int d>
std::size_t stride(const Eigen::Ref<const Points<d>>& points) {
  return d == 1 ? 1 : static_cast<std::size_t>(points.outerStride());
}

/// Points as columns brought to [d][count].
template <int d>
gaussdrift::core::Buffer<double> by_axis(const double* points, std::size_t count, std::size_t point_stride,
                                         int threads) {
  constexpr std::size_t piece = 1 << 14;
  gaussdrift::core::Buffer<double> position(d * count);
  gaussdrift::base::parallel_for({(count + piece - 1) / piece, 1e-9 * static_cast<double>(d * count)}, threads,
                                 [&](std::size_t i) {
                                   for (std::size_t j = i * piece; j < std::min(count, (i + 1) * piece); ++j)
                                     for (std::size_t l = 0; l < d; ++l)
                                       position[l * count + j] = points[j * point_stride + l];
                                 });
  return position;
}

/// Not set to anything.
inline Eigen::MatrixXd make_result(std::size_t rows, std::size_t columns) {
  Eigen::MatrixXd values(static_cast<Eigen::Index>(rows), static_cast<Eigen::Index>(columns));
  gaussdrift::core::prefer_huge_pages(values.data(), 8 * rows * columns);
  return values;
}

}  // namespace fgtd::detail
