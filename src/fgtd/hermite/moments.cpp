// Moments of the boxes [Sch06, Algorithm 3.6], as products of matrices: with powers tabulated an axis,
//   A[(b_{d-1} .. b_1)][b_0] = sum_j Q[(b_{d-1} .. b_1)][j] (lambda_j X[j][b_0]),
//   X[j][b] = (sqrt 2 t_0)^b / sqrt(b!),   Q[..][j] = prod_{l > 0} (sqrt 2 t_l)^{b_l} / sqrt(b_l!)
//   t = sqrt(sigma) (x_j - c)
#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "fgtd/cost.hpp"
#include "fgtd/hermite/hermite.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

constexpr std::size_t chunk = 64;           // sources whose powers are tabulated at a time
constexpr std::size_t piece_sources = 512;  // a piece of parallel work has at least so many sources

/// Boxes cut into pieces of similar work: the first box of each piece, and the number of boxes at the end.
std::vector<std::size_t> cut(const std::vector<std::size_t>& first) {
  const std::size_t boxes = first.size() - 1;
  std::vector<std::size_t> cuts{0};
  for (std::size_t box = 0; box < boxes; ++box)
    if (first[box + 1] - first[cuts.back()] >= piece_sources || box + 1 == boxes) cuts.push_back(box + 1);
  return cuts;
}

/// Tables of the powers of a chunk of sources.
struct Powers {
  std::size_t terms, padded;
  std::vector<double> root;         // (x^b / sqrt(b!)) = root[b] x * (x^{b-1} / sqrt((b-1)!))
  std::vector<double> of_axis;      // [b][j]
  std::vector<double> left, right;  // Q [b_{d-1} .. b_1][j], X [j][b_0]

  Powers(std::size_t p, std::size_t rows)
      : terms(p),
        padded((p + row_padding - 1) / row_padding * row_padding),
        root(p),
        of_axis(p * chunk),
        left(rows * chunk),
        right(chunk * padded) {
    for (std::size_t b = 1; b < p; ++b) root[b] = 1 / std::sqrt(static_cast<double>(b));
  }

  /// Sources begin .. begin + size of `position` ([d][count]); scale = sqrt(2 sigma).
  template <int d>
  void fill(const double* position, std::size_t count, std::size_t begin, std::size_t size, const double* centre,
            double scale) {
    std::size_t filled = 1;  // rows of `left` so far
    std::fill_n(left.begin(), size, 1.0);
    for (std::size_t l = 0; l < d; ++l) {
      const double* x = position + l * count + begin;
      std::fill_n(of_axis.begin(), size, 1.0);
      for (std::size_t b = 1; b < terms; ++b)
        for (std::size_t j = 0; j < size; ++j)
          of_axis[b * chunk + j] = of_axis[(b - 1) * chunk + j] * ((x[j] - centre[l]) * scale) * root[b];
      if (l == 0) {
        for (std::size_t j = 0; j < size; ++j)
          for (std::size_t b = 0; b < terms; ++b) right[j * padded + b] = of_axis[b * chunk + j];
        continue;
      }
      for (std::size_t b = terms; b-- > 0;)  // from the end, so that the rows of b = 0 are read before they are scaled
        for (std::size_t m = 0; m < filled; ++m)
          for (std::size_t j = 0; j < size; ++j)
            left[(b * filled + m) * chunk + j] = left[m * chunk + j] * of_axis[b * chunk + j];
      filled *= terms;
    }
  }
};

}  // namespace

std::size_t power(int p, int n) {
  std::size_t product = 1;
  for (int i = 0; i < n; ++i) product *= static_cast<std::size_t>(p);
  return product;
}

std::vector<double> binomial_roots(int highest, int terms) {
  std::vector<double> roots;
  for (int a = 0; a <= highest; ++a)
    for (int b = 0; b < terms; ++b) {
      double binomial = 1;
      for (int i = 1; i <= a; ++i) binomial = binomial * (b + i) / i;
      roots.push_back(std::sqrt(binomial));
    }
  return roots;
}

template <int d>
HermiteSum<d>::HermiteSum(const HermitePlan& plan, double sigma, double side, Buffer<double> position,
                          std::size_t count, int threads)
    : plan_(plan), sigma_(sigma), threads_(threads) {
  sources_.count = count;
  sources_.position = std::move(position);
  boxes_ = make_boxes<d>(sources_.position, count, side, order_);
}

template <int d>
double HermiteSum<d>::plan_bytes(std::size_t columns) const {
  const double sources = static_cast<double>(sources_.count), moments = static_cast<double>(power(plan_.terms, d));
  return 8 * (sources * static_cast<double>(d + columns + 1) +
              static_cast<double>(boxes_.count()) * (static_cast<double>(columns) * moments + 3 * d));
}

template <int d>
void HermiteSum<d>::set_weights(const double* weights, std::size_t columns) {
  Sources<d>& sources = sources_;
  sources.columns = columns;
  sources.weights = reordered_weights(weights, columns, order_);
  const std::size_t p = static_cast<std::size_t>(plan_.terms);
  const std::size_t rows = power(plan_.terms, d - 1);
  columns_ = sources.columns;
  moments_.assign(boxes_.count() * columns_ * rows * p, 0.0);
  if (moments_.empty()) return;

  const double scale = std::sqrt(2.0) * std::sqrt(sigma_);

  const std::vector<std::size_t>& first = boxes_.level[0].first;
  const std::vector<std::size_t> cuts = cut(first);
  const double a_source = static_cast<double>(columns_ * rows * p) * cost::moment_step;
  const gaussdrift::base::Pieces pieces(cuts.size() - 1, static_cast<double>(sources.count) * a_source);
  gaussdrift::base::parallel_for(pieces, threads_, [&](std::size_t piece) {
    Powers powers(p, rows);
    const std::size_t padded = powers.padded;
    std::vector<double> weighted(chunk * padded);
    for (std::size_t box = cuts[piece]; box < cuts[piece + 1]; ++box)
      for (std::size_t begin = first[box]; begin < first[box + 1]; begin += chunk) {
        const std::size_t size = std::min(chunk, first[box + 1] - begin);
        powers.fill<d>(sources.position.data(), sources.count, begin, size, boxes_.centre.data() + box * d, scale);
        for (std::size_t k = 0; k < columns_; ++k) {
          const double* row = sources.weights.data() + k * sources.count + begin;
          for (std::size_t j = 0; j < size; ++j)
            for (std::size_t b = 0; b < p; ++b) weighted[j * padded + b] = row[j] * powers.right[j * padded + b];
          kernels().product({.rows = rows,
                             .depth = size,
                             .width = p,
                             .b = powers.left.data(),
                             .b_stride = chunk,
                             .d = weighted.data(),
                             .d_stride = padded,
                             .c = moments_.data() + (box * columns_ + k) * rows * p,
                             .c_stride = p});
        }
      }
  });
}

#define FGTD_INSTANTIATE(d)                                                                                 \
  template HermiteSum<d>::HermiteSum(const HermitePlan&, double, double, Buffer<double>, std::size_t, int); \
  template double HermiteSum<d>::plan_bytes(std::size_t) const;                                             \
  template void HermiteSum<d>::set_weights(const double*, std::size_t);
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
