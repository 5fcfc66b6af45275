// Hands groups of targets to the kernel of pairs. A group is summed in the same order on every thread.
#include "rbf/direct.hpp"

#include <algorithm>

#include "base/parallel.hpp"
#include "rbf/derivatives.hpp"
#include "rbf/kernels/kernels.hpp"

namespace rbf::detail {
double pair_seconds(Kernel kernel) {
  switch (kernel) {
    case Kernel::inverse_quadratic:
      return 0.7e-9;
    case Kernel::multiquadric:
    case Kernel::gaussian:
      return 1.0e-9;
    default:
      return 1.6e-9;
  }
}

template <int d>
DirectSum<d>::DirectSum(const Function& function, const Points<d>& centres, int threads)
    : function_(function), sources_(static_cast<std::size_t>(centres.cols())), threads_(threads) {
  position_.resize(d * sources_);
  for (std::size_t j = 0; j < sources_; ++j)
    for (std::size_t l = 0; l < d; ++l) position_[l * sources_ + j] = centres.data()[j * d + l];
}

template <int d>
Eigen::MatrixXd DirectSum<d>::evaluate(std::size_t count, const std::vector<Combination<d>>& combinations,
                                       const std::function<void(std::size_t, double*)>& point) const {
  const Eigen::Index columns = weights_.cols();
  const int order = highest_order<d>(combinations);
  Eigen::MatrixXd values =
      Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(count), columns * static_cast<Eigen::Index>(combinations.size()));
  const std::size_t groups = (count + group_size - 1) / group_size, outputs = derivatives_up_to(d, order);
  const double pairs = static_cast<double>(count) * static_cast<double>(sources_) * static_cast<double>(columns);
  gaussdrift::base::parallel_for({groups, pairs * pair_seconds(function_.kernel)}, threads_, [&](std::size_t group) {
    const std::size_t begin = group * group_size, size = std::min(group_size, count - begin);
    double target[d * group_size], out[most_derivatives * group_size];
    for (std::size_t i = 0; i < group_size; ++i) {
      double coordinates[d];
      point(begin + std::min(i, size - 1), coordinates);
      for (std::size_t l = 0; l < d; ++l) target[l * group_size + i] = coordinates[l];
    }
    for (Eigen::Index column = 0; column < columns; ++column) {
      std::fill_n(out, outputs * group_size, 0.0);
      fastest_kernels().pairs({.dimension = d,
                               .kernel = function_.kernel,
                               .shape = function_.shape,
                               .order = order,
                               .sources = sources_,
                               .position = position_.data(),
                               .weights = weights_.col(column).data(),
                               .target = target,
                               .out = out});
      for (std::size_t q = 0; q < combinations.size(); ++q) {
        double* const to = values.col(static_cast<Eigen::Index>(q) * columns + column).data() + begin;
        for (const fgtd::Term<d>& term : combinations[q]) {
          const double* const from = out + place_of<d>(term.derivative) * group_size;
          for (std::size_t i = 0; i < size; ++i) to[i] += term.coefficient * from[i];
        }
      }
    }
  });
  return values;
}

template class DirectSum<1>;
template class DirectSum<2>;
template class DirectSum<3>;

}  // namespace rbf::detail
