// Numbers in rows: a picture (PNG) in grey, a table (CSV) without a header.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace gaussdrift::read {

struct Matrix {
  std::size_t columns = 0, rows = 0;
  std::vector<double> values;  // from the lower left, columns fastest; the first row of a file is the uppermost
};

/// 0 for black, 1 for white; what is transparent is dark. Throws GridFileError: no PNG, damaged, interlaced.
Matrix read_grey_png(const std::filesystem::path& file);
/// Numbers between commas, semicolons or blanks; lines with # are remarks. Throws GridFileError.
Matrix read_csv_matrix(const std::filesystem::path& file);

}  // namespace gaussdrift::read
