// NumPy arrays as the libraries see them, and their results as NumPy arrays. Points are rows in Python and columns in the
// libraries, which is the same memory: nothing is copied where a row is contiguous.
#pragma once

#include <pybind11/numpy.h>

#include <Eigen/Core>
#include <stdexcept>
#include <string>
#include <utility>

namespace gaussdrift::python {

/// Points in the rows of an array, d x N for the libraries. They stay where they are, or in a copy that is kept here.
class Rows {
 public:
  /// @param numbers  N x d, or N numbers for points on a line; real
  /// @param name     of the argument, for messages
  /// Throws std::invalid_argument where it has another shape or no numbers.
  Rows(const pybind11::object& numbers, const char* name);

  int dimension() const { return dimension_; }
  /// The points of a dimension that is known to be dimension().
  template <int d>
  auto columns() const {
    using Columns = Eigen::Matrix<double, d, Eigen::Dynamic>;
    return Eigen::Map<const Columns, 0, Eigen::OuterStride<>>(first_, d, count_, Eigen::OuterStride<>(stride_));
  }

 private:
  pybind11::array kept_;
  const double* first_ = nullptr;
  Eigen::Index count_ = 0;
  Eigen::Index stride_ = 0;  // numbers from point to point
  int dimension_ = 1;
};

/// act.operator()<d>() for the dimension of these points. Throws std::invalid_argument where it is above `most`.
template <int most, class Act>
auto in_dimension(const Rows& points, const char* name, const Act& act) {
  switch (points.dimension()) {
    case 1:
      return act.template operator()<1>();
    case 2:
      return act.template operator()<2>();
    case 3:
      return act.template operator()<3>();
    case 4:
      if constexpr (most == 4) return act.template operator()<4>();
  }
  throw std::invalid_argument(std::string(name) + " must have 1 to " + std::to_string(most) +
                              " coordinates, a point a row; they have " + std::to_string(points.dimension()));
}

/// Weights: N numbers, or N x c for c columns.
class Weights {
 public:
  /// As Rows.
  Weights(const pybind11::object& numbers, const char* name);

  /// N x c.
  auto matrix() const {
    return Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>(first_, rows_, columns_,
                                                                      Eigen::OuterStride<>(stride_));
  }

 private:
  pybind11::array kept_;
  const double* first_ = nullptr;
  Eigen::Index rows_ = 0;
  Eigen::Index columns_ = 1;
  Eigen::Index stride_ = 0;  // numbers from column to column
};

/// The matrix as an array of the same shape, which owns it; its columns are contiguous.
pybind11::array array_of(Eigen::MatrixXd&& matrix);
/// The points d x M as an array M x d with contiguous rows, which owns them.
template <int d>
pybind11::array array_of_points(Eigen::Matrix<double, d, Eigen::Dynamic>&& points) {
  using Points = Eigen::Matrix<double, d, Eigen::Dynamic>;
  auto* kept = new Points(std::move(points));
  const pybind11::capsule owner(kept, [](void* matrix) { delete static_cast<Points*>(matrix); });
  return pybind11::array_t<double>({kept->cols(), Eigen::Index{d}}, kept->data(), owner);
}

}  // namespace gaussdrift::python
