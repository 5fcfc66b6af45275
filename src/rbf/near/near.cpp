#include "rbf/near/near.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.hpp"
#include "rbf/derivatives.hpp"
#include "rbf/kernels/kernels.hpp"

namespace rbf::detail {

template <int d>
NearField<d>::NearField(const Function& function, const CellGrid<d>& lattice, double radius, Smooth smooth,
                        const Points<d>& centres, int threads)
    : function_(function),
      lattice_(lattice),
      radius_(radius),
      smooth_(std::move(smooth)),
      threads_(threads),
      sorted_(lattice, centres.data(), static_cast<std::size_t>(centres.cols())),
      stride_(sorted_.order.size() + near_padding),
      position_(d * stride_) {
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t j = 0; j < sorted_.order.size(); ++j)
      position_[l * stride_ + j] = centres.data()[sorted_.order[j] * d + l];
}

template <int d>
void NearField<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  columns_ = weights.cols();
  weights_.assign(static_cast<std::size_t>(columns_) * stride_, 0.0);
  for (Eigen::Index column = 0; column < columns_; ++column)
    for (std::size_t j = 0; j < sorted_.order.size(); ++j)
      weights_[static_cast<std::size_t>(column) * stride_ + j] =
          weights(static_cast<Eigen::Index>(sorted_.order[j]), column);
}

template <int d>
void NearField<d>::add(const double* targets, std::size_t count, const std::vector<Combination<d>>& combinations,
                       Eigen::MatrixXd& values) const {
  const int order = highest_order<d>(combinations);
  const SortedPoints<d> sorted(lattice_, targets, count);
  constexpr std::size_t rows = d == 1 ? 1 : d == 2 ? 3 : 9, cells_a_piece = 32;
  NearJob common{.dimension = d,
                 .kernel = function_.kernel,
                 .shape = function_.shape,
                 .order = order,
                 .radius = radius_,
                 .smooth = {},
                 .stride = stride_,
                 .position = position_.data(),
                 .weights = nullptr,
                 .runs = nullptr,
                 .run_count = 0,
                 .target = nullptr,
                 .out = nullptr};
  for (std::size_t j = 0; j < 3; ++j)
    common.smooth[j] = {smooth_.coefficients[j].data(), smooth_.coefficients[j].size()};
  const std::size_t cells = sorted.keys.size();
  gaussdrift::base::parallel_for(
      {(cells + cells_a_piece - 1) / cells_a_piece, 2e-7 * static_cast<double>(count)}, threads_,
      [&](std::size_t piece) {
        NearJob job = common;
        Run runs[rows];
        double out[most_derivatives];
        for (std::size_t c = piece * cells_a_piece; c < std::min(cells, (piece + 1) * cells_a_piece); ++c) {
          const std::array<std::int64_t, d> cell = lattice_.cell(targets + sorted.order[sorted.first[c]] * d);
          job.run_count = 0;
          for (std::size_t row = 0; row < rows; ++row) {
            std::array<std::int64_t, d> low = cell;
            low[0] -= 1;
            if constexpr (d > 1) low[1] += static_cast<std::int64_t>(row % 3) - 1;
            if constexpr (d > 2) low[2] += static_cast<std::int64_t>(row / 3) - 1;
            const std::uint64_t key = lattice_.key(low);
            const auto begin = std::lower_bound(sorted_.keys.begin(), sorted_.keys.end(), key);
            auto end = begin;
            while (end != sorted_.keys.end() && *end <= key + 2) ++end;
            if (begin == end) continue;
            runs[job.run_count++] = {sorted_.first[static_cast<std::size_t>(begin - sorted_.keys.begin())],
                                     sorted_.first[static_cast<std::size_t>(end - sorted_.keys.begin())]};
          }
          job.runs = runs;
          job.out = out;
          for (std::size_t i = sorted.first[c]; i < sorted.first[c + 1] && job.run_count > 0; ++i) {
            const std::size_t target = sorted.order[i];
            job.target = targets + target * d;
            for (Eigen::Index column = 0; column < columns_; ++column) {
              job.weights = weights_.data() + static_cast<std::size_t>(column) * stride_;
              fastest_kernels().near(job);
              for (std::size_t q = 0; q < combinations.size(); ++q)
                for (const fgtd::Term<d>& term : combinations[q])
                  values(static_cast<Eigen::Index>(target), static_cast<Eigen::Index>(q) * columns_ + column) +=
                      term.coefficient * out[place_of<d>(term.derivative)];
            }
          }
        }
      });
}

template <int d>
double distance_of_neighbours(const Points<d>& centres, double neighbours) {
  const std::size_t count = static_cast<std::size_t>(centres.cols());
  const std::size_t some = std::min<std::size_t>(count, 128),
                    others = std::min<std::size_t>(count, count > 1000000 ? 16384 : 2048);
  std::vector<double> squares;
  squares.reserve(some * others);
  for (std::size_t a = 0; a < some; ++a)
    for (std::size_t b = 0; b < others; ++b) {
      const std::size_t i = a * count / some, j = b * count / others;
      if (i == j) continue;
      double squared = 0;
      for (std::size_t l = 0; l < d; ++l) {
        const double apart = centres.data()[i * d + l] - centres.data()[j * d + l];
        squared += apart * apart;
      }
      squares.push_back(squared);
    }
  if (squares.empty()) return 0;
  const std::size_t rank = static_cast<std::size_t>(
      std::min(static_cast<double>(squares.size() - 1),
               std::max(4.0, neighbours / static_cast<double>(count) * static_cast<double>(squares.size()))));
  const auto at = squares.begin() + static_cast<std::ptrdiff_t>(std::min(rank, squares.size() - 1));
  std::nth_element(squares.begin(), at, squares.end());
  return std::sqrt(*at);
}

template class NearField<1>;
template class NearField<2>;
template class NearField<3>;
template double distance_of_neighbours<1>(const Points<1>&, double);
template double distance_of_neighbours<2>(const Points<2>&, double);
template double distance_of_neighbours<3>(const Points<3>&, double);

}  // namespace rbf::detail
