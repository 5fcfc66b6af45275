// The request of an evaluation as flat lists: the distinct derivatives, and every combination as a list of (derivative,
// factor). A factor contains the sign and the scale of its derivative,
//   D^alpha exp(-sigma |y-x|^2) = (-1)^|alpha| N_alpha prod_l h~_{alpha_l}(sqrt(sigma) (y-x)_l)
//   h~_n = h_n / sqrt(2^n n!)
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "fgtd/fgtd.hpp"
#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {

template <int d>
struct Request {
  struct Part {
    std::size_t derivative;  // index into `derivatives`
    double factor;           // coefficient (-1)^|alpha| N_alpha
  };
  std::vector<Derivative<d>> derivatives;  // distinct
  std::vector<std::vector<Part>> combinations;
  std::array<int, d> highest{};  // of each axis
};

/// Throws InvalidArgument if a derivative is negative, beyond `derivative_order`, or its scale is not a double.
template <int d>
Request<d> make_request(const std::vector<Combination<d>>& combinations, double sigma, int derivative_order);

/// The request as the kernels of single pairs read it: terms first[q] .. first[q+1] belong to combination q, each with
/// max_dimension orders and a factor.
template <int d>
struct FlatTerms {
  std::vector<std::size_t> first{0};
  std::vector<int> order;
  std::vector<double> coefficient;

  explicit FlatTerms(const Request<d>& request) {
    for (const auto& combination : request.combinations) {
      for (const auto& part : combination) {
        for (std::size_t l = 0; l < max_dimension; ++l)
          order.push_back(l < d ? request.derivatives[part.derivative][l] : 0);
        coefficient.push_back(part.factor);
      }
      first.push_back(coefficient.size());
    }
  }
};

/// The factors sqrt(2/(n+1)) and sqrt(n/(n+1)) of the recurrence, for n < orders.
class RecurrenceTable {
 public:
  explicit RecurrenceTable(int orders);
  Recurrence view() const { return {up_.data(), back_.data()}; }

 private:
  std::vector<double> up_, back_;
};

}  // namespace fgtd::detail
