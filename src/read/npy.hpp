// Arrays as NumPy saves them (.npy): one or two axes of Float64 or Float32, little-endian, in either order of memory.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace gaussdrift::read {

/// The bytes that the file of an array begins with.
constexpr std::string_view npy_mark = "\x93NUMPY";

struct NpyArray {
  std::size_t rows = 0, columns = 1;
  bool column_after_column = false;  // fortran_order
  bool single = false;               // Float32
  std::string_view numbers;          // as they stand in the file: rows * columns of them

  /// Every `stride`-th of `to` becomes a number of the column.
  void copy_column(std::size_t column, double* to, std::size_t stride) const;
};

/// `bytes` are the whole file, and must outlive the result. Throws GridFileError: no such array, of other numbers, with
/// more or fewer bytes than its head says. Takes no memory. `name` stands for the file in messages.
NpyArray parse_npy(std::string_view bytes, const std::string& name);

}  // namespace gaussdrift::read
