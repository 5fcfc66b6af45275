// Looks at numbers that a caller gives; see arguments.hpp.
#include "core/arguments.hpp"

#include <algorithm>
#include <atomic>
#include <charconv>
#include <cmath>

#include "base/parallel.hpp"

namespace gaussdrift::core {

std::string text(double value) {
  char buffer[64];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, value).ptr;
  return std::string(buffer, end);
}

namespace {

constexpr std::size_t piece = 1 << 15;  // numbers looked at together

/// x - x is 0 for finite x and NaN otherwise, and a sum with a NaN stays NaN.
bool row_is_finite(const double* row, std::size_t count) {
  double sum[8] = {};
  std::size_t i = 0;
  for (; i + 8 <= count; i += 8)
    for (std::size_t k = 0; k < 8; ++k) sum[k] += row[i + k] - row[i + k];
  for (; i < count; ++i) sum[0] += row[i] - row[i];
  double all = 0;
  for (const double part : sum) all += part;
  return all == 0;
}

}  // namespace

bool all_finite(const double* data, std::size_t rows, std::size_t columns, std::size_t stride, int threads) {
  if (stride == rows || columns == 1) {  // without gaps: one long row
    rows *= columns;
    columns = 1;
    stride = rows;
  }
  if (rows == 0) return true;
  const std::size_t pieces = (rows + piece - 1) / piece;                // of a column
  const std::size_t together = std::max<std::size_t>(1, piece / rows);  // columns
  std::atomic<bool> finite{true};
  const base::Pieces parts(pieces * ((columns + together - 1) / together),
                           0.5e-9 * static_cast<double>(rows * columns));
  base::parallel_for(parts, threads, [&](std::size_t i) {
    const std::size_t begin = i % pieces * piece, end = std::min(rows, begin + piece);
    for (std::size_t k = i / pieces * together; k < std::min(columns, (i / pieces + 1) * together); ++k)
      if (!row_is_finite(data + k * stride + begin, end - begin)) finite = false;
  });
  return finite;
}

std::optional<std::string> point_that_is_not_finite(const char* kind, const double* points, std::size_t dimension,
                                                    std::size_t count, std::size_t stride, int threads) {
  if (all_finite(points, dimension, count, stride, threads)) return std::nullopt;
  // Which one it is need not be found fast.
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t l = 0; l < dimension; ++l) {
      const double value = points[j * stride + l];
      if (!std::isfinite(value))
        return std::string(kind) + " " + std::to_string(j) + ", coordinate " + std::to_string(l) + " is " +
               text(value) + "; " + kind + "s must be finite";
    }
  return std::nullopt;
}

}  // namespace gaussdrift::core
