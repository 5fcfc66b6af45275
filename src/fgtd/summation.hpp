// The interface of every method: a sum that is prepared for one set of sources. All others are tested against `direct`.
// catalogue.hpp says how to add one.
#pragma once

#include <cstddef>
#include <vector>

#include "fgtd/fgtd.hpp"
#include "fgtd/request.hpp"

namespace fgtd::detail {

template <int d>
class Summation {
 public:
  virtual ~Summation() = default;

  /// weights [columns][sources], in the order in which the caller gave the sources.
  virtual void set_weights(const double* weights, std::size_t columns) = 0;

  /// values[(q columns + k) count + i] for combination q, column k, target i; overwritten. targets [count][d],
  /// anywhere.
  virtual void evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const = 0;
  /// The same on a tensor grid with ascending nodes, first axis fastest.
  virtual void evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const = 0;

  /// Bytes that the plan holds with so many columns of weights.
  virtual double plan_bytes(std::size_t columns) const = 0;
  /// Bytes that evaluate() takes beside its result.
  virtual double point_bytes(const Request<d>& request, std::size_t count) const = 0;
  virtual double grid_bytes(const Request<d>& request, const TensorGrid& grid) const = 0;

  /// Completes the parameters of the choice with what is counted when the sum is made: occupied boxes, bricks.
  virtual void count(Choice&) const {}
};

/// The weights in another order: result[k][j] = weights[k][order[j]].
inline std::vector<double> reordered_weights(const double* weights, std::size_t columns,
                                             const std::vector<std::size_t>& order) {
  std::vector<double> result(columns * order.size());
  for (std::size_t k = 0; k < columns; ++k)
    for (std::size_t j = 0; j < order.size(); ++j) result[k * order.size() + j] = weights[k * order.size() + order[j]];
  return result;
}

}  // namespace fgtd::detail
