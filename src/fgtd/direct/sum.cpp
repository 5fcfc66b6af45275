// Hands groups of targets to the kernel `direct`. A group is summed in the same order on every thread.
#include "fgtd/direct/sum.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "fgtd/cost.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {
namespace {

/// point(i, coordinates) writes target i.
template <int d, class Point>
void evaluate(const Sources<d>& sources, double sigma, const Request<d>& request, std::size_t count, int threads,
              double* values, const Point& point) {
  const FlatTerms<d> terms(request);
  const RecurrenceTable recurrence(max_derivative_order + 1);
  const std::size_t outputs = request.combinations.size() * sources.columns;
  if (outputs == 0) return;
  const std::size_t groups = (count + group_size - 1) / group_size;
  constexpr std::size_t groups_a_piece = 4;

  const double pairs = static_cast<double>(count) * static_cast<double>(sources.count * sources.columns);
  const gaussdrift::base::Pieces pieces((groups + groups_a_piece - 1) / groups_a_piece,
                                        pairs * cost::direct_pair[d - 1]);
  gaussdrift::base::parallel_for(pieces, threads, [&](std::size_t piece) {
    std::vector<double> out(outputs * group_size);
    double target[d * group_size];
    for (std::size_t group = piece * groups_a_piece; group < std::min(groups, (piece + 1) * groups_a_piece); ++group) {
      const std::size_t begin = group * group_size;
      const std::size_t size = std::min(group_size, count - begin);
      for (std::size_t i = 0; i < group_size; ++i) {
        double coordinates[d];
        point(begin + std::min(i, size - 1), coordinates);
        for (std::size_t l = 0; l < d; ++l) target[l * group_size + i] = coordinates[l];
      }
      kernels().direct({.dimension = d,
                        .sigma = sigma,
                        .root_sigma = std::sqrt(sigma),
                        .sources = sources.count,
                        .position = sources.position.data(),
                        .columns = sources.columns,
                        .weights = sources.weights.data(),
                        .combinations = request.combinations.size(),
                        .first_term = terms.first.data(),
                        .order = terms.order.data(),
                        .coefficient = terms.coefficient.data(),
                        .highest = request.highest.data(),
                        .recurrence = recurrence.view(),
                        .target = target,
                        .out = out.data()});
      for (std::size_t output = 0; output < outputs; ++output)
        std::copy_n(out.data() + output * group_size, size, values + output * count + begin);
    }
  });
}

}  // namespace

template <int d>
void evaluate_direct(const Sources<d>& sources, double sigma, const Request<d>& request, const double* targets,
                     std::size_t count, int threads, double* values) {
  evaluate<d>(sources, sigma, request, count, threads, values,
              [&](std::size_t i, double* coordinates) { std::copy_n(targets + i * d, d, coordinates); });
}

template <int d>
void evaluate_direct(const Sources<d>& sources, double sigma, const Request<d>& request, const TensorGrid& grid,
                     int threads, double* values) {
  evaluate<d>(sources, sigma, request, grid.size(), threads, values, [&](std::size_t i, double* coordinates) {
    for (std::size_t l = 0; l < d; ++l) {
      const auto& nodes = grid.axes[l];
      coordinates[l] = nodes[i % nodes.size()];
      i /= nodes.size();
    }
  });
}

template <int d>
DirectSum<d>::DirectSum(Buffer<double> position, std::size_t count, double sigma, int threads)
    : sigma_(sigma), threads_(threads) {
  sources_.count = count;
  sources_.position = std::move(position);
}

template <int d>
void DirectSum<d>::set_weights(const double* weights, std::size_t columns) {
  sources_.columns = columns;
  sources_.weights.assign(weights, weights + columns * sources_.count);
}

#define FGTD_INSTANTIATE(d)                                                                                        \
  template void evaluate_direct<d>(const Sources<d>&, double, const Request<d>&, const double*, std::size_t, int,  \
                                   double*);                                                                       \
  template void evaluate_direct<d>(const Sources<d>&, double, const Request<d>&, const TensorGrid&, int, double*); \
  template class DirectSum<d>;
FGTD_INSTANTIATE(1)
FGTD_INSTANTIATE(2)
FGTD_INSTANTIATE(3)
FGTD_INSTANTIATE(4)
#undef FGTD_INSTANTIATE

}  // namespace fgtd::detail
