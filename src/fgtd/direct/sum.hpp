// The definition: every source at every target. All other methods are tested against it, and for few points it is the
// fastest.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "core/buffer.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/request.hpp"
#include "fgtd/summation.hpp"

namespace fgtd::detail {

struct MethodEntry;

using gaussdrift::core::Buffer;

/// Sources as the sums need them: one array an axis, one array a column of weights.
template <int d>
struct Sources {
  std::size_t count = 0;
  std::size_t columns = 0;
  Buffer<double> position;      // [d][count]
  std::vector<double> weights;  // [columns][count]
};

/// values[(q columns + k) targets + i]; targets [targets][d].
template <int d>
void evaluate_direct(const Sources<d>& sources, double sigma, const Request<d>& request, const double* targets,
                     std::size_t count, int threads, double* values);

/// The same on a tensor grid, first axis fastest.
template <int d>
void evaluate_direct(const Sources<d>& sources, double sigma, const Request<d>& request, const TensorGrid& grid,
                     int threads, double* values);

template <int d>
class DirectSum : public Summation<d> {
 public:
  /// position [d][count]
  DirectSum(Buffer<double> position, std::size_t count, double sigma, int threads);

  void set_weights(const double* weights, std::size_t columns) override;
  void evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const override {
    evaluate_direct<d>(sources_, sigma_, request, targets, count, threads_, values);
  }
  void evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const override {
    evaluate_direct<d>(sources_, sigma_, request, grid, threads_, values);
  }
  double plan_bytes(std::size_t columns) const override {
    return 8.0 * static_cast<double>(sources_.count) * static_cast<double>(d + columns);
  }
  double point_bytes(const Request<d>&, std::size_t) const override { return 0; }
  double grid_bytes(const Request<d>&, const TensorGrid&) const override { return 0; }

 private:
  Sources<d> sources_;
  double sigma_;
  int threads_;
};

/// The method `direct` for the catalogue.
MethodEntry direct_method();

}  // namespace fgtd::detail
