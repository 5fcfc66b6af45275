// Which arrays are taken as they are, and which are copied once.
#include "python/arrays.hpp"

#include <cstdint>

namespace gaussdrift::python {

namespace py = pybind11;

namespace {

constexpr py::ssize_t size = sizeof(double);

std::string shape_of(const py::array& array) { return py::str(array.attr("shape")).cast<std::string>(); }

/// An array of doubles with one or two axes, without a copy if it is one.
py::array doubles(const py::object& numbers, const char* name, const char* shape) {
  py::array array = py::array::ensure(numbers);
  if (!array) {
    PyErr_Clear();
    throw std::invalid_argument(std::string(name) + " must be an array " + shape + " of numbers");
  }
  if (array.ndim() < 1 || array.ndim() > 2) {
    throw std::invalid_argument(std::string(name) + " must be an array " + shape + "; its shape is " + shape_of(array));
  }
  if (std::string("fiub").find(array.dtype().kind()) == std::string::npos) {
    throw std::invalid_argument(std::string(name) + " must hold real numbers; its dtype is " +
                                py::str(array.dtype()).cast<std::string>());
  }
  return py::array_t<double, py::array::forcecast>(array);
}

bool whole_numbers_apart(py::ssize_t stride, py::ssize_t least) { return stride % size == 0 && stride / size >= least; }

bool is_aligned(const py::array& array) {
  return reinterpret_cast<std::uintptr_t>(array.data()) % alignof(double) == 0;
}

}  // namespace

Rows::Rows(const py::object& numbers, const char* name) : kept_(doubles(numbers, name, "N x d, a point a row,")) {
  const bool line = kept_.ndim() == 1;
  count_ = kept_.shape(0);
  dimension_ = line ? 1 : static_cast<int>(kept_.shape(1));
  const bool in_place = is_aligned(kept_) && (count_ < 2 || whole_numbers_apart(kept_.strides(0), dimension_)) &&
                        (dimension_ < 2 || kept_.strides(1) == size);
  if (!in_place) kept_ = py::array_t<double, py::array::c_style | py::array::forcecast>(kept_.attr("copy")("C"));
  first_ = static_cast<const double*>(kept_.data());
  stride_ = count_ < 2 ? dimension_ : kept_.strides(0) / size;
}

Weights::Weights(const py::object& numbers, const char* name) : kept_(doubles(numbers, name, "of N numbers or N x c")) {
  rows_ = kept_.shape(0);
  columns_ = kept_.ndim() == 1 ? 1 : kept_.shape(1);
  const bool one = columns_ < 2;
  const bool in_place = is_aligned(kept_) && (rows_ < 2 || kept_.strides(0) == size) &&
                        (one || whole_numbers_apart(kept_.strides(1), rows_));
  if (!in_place) kept_ = kept_.attr("copy")("F");
  first_ = static_cast<const double*>(kept_.data());
  stride_ = one ? rows_ : kept_.strides(1) / size;
}

py::array array_of(Eigen::MatrixXd&& matrix) {
  auto* kept = new Eigen::MatrixXd(std::move(matrix));
  const py::capsule owner(kept, [](void* numbers) { delete static_cast<Eigen::MatrixXd*>(numbers); });
  return py::array_t<double>({kept->rows(), kept->cols()}, {size, size * kept->rows()}, kept->data(), owner);
}

}  // namespace gaussdrift::python
