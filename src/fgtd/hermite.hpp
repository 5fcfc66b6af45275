// The thesis's algorithm [Sch06, ch. 3]: moments of boxes, and Hermite functions of the neighbour boxes at the targets.
//   s_alpha(y) = (-1)^|alpha| N_alpha sum_{boxes B} sum_{beta < p} A_beta(B) g_{alpha,beta}(sqrt(sigma) (y - c_B))
//   A_beta(B)  = sum_{x_j in B} lambda_j prod_l (sqrt(2 sigma) (x_j - c_B)_l)^{beta_l} / sqrt(beta_l!)
//   g_{a,b}(t) = sqrt(binomial(a+b, a)) h~_{a+b}(t),   h~_n = h_n / sqrt(2^n n!)
// which is (3.3) with both factors scaled so that they stay of size one whatever the order.
#pragma once

#include <limits>
#include <vector>

#include "fgtd/boxes.hpp"
#include "fgtd/direct.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/request.hpp"

namespace fgtd::detail {

/// r, p, n with the distance beyond which a box is left out.
struct HermitePlan {
  double box_scale = 0;                                    // r
  int terms = 0;                                           // p
  int neighbours = 0;                                      // n, or HermiteParameters::all_boxes
  double reach = std::numeric_limits<double>::infinity();  // times sqrt(sigma); infinite if n alone decides
};

template <int d>
class HermiteSum {
 public:
  HermiteSum(const HermitePlan& plan, double sigma, Boxes<d> boxes);

  /// sources sorted by box.
  void set_moments(const Sources<d>& sources, int threads);

  /// values as in evaluate_direct().
  void evaluate(const Request<d>& request, const double* targets, std::size_t count, int threads, double* values) const;
  void evaluate(const Request<d>& request, const TensorGrid& grid, int threads, double* values) const;

  const Boxes<d>& boxes() const { return boxes_; }
  const HermitePlan& plan() const { return plan_; }

  /// Bytes that evaluate() takes beside its result.
  double point_bytes(const Request<d>& request, double targets) const;
  double grid_bytes(const Request<d>& request, const TensorGrid& grid) const;

 private:
  HermitePlan plan_;
  double sigma_;
  Boxes<d> boxes_;
  std::size_t columns_ = 0;
  std::vector<double> moments_;  // [boxes][columns][p^d], first axis fastest
};

/// g_{a,b} needs sqrt(binomial(a+b, a)), a = 0 .. highest, b = 0 .. terms-1: table[a][b].
std::vector<double> binomial_roots(int highest, int terms);

/// p^n
std::size_t power(int p, int n);

}  // namespace fgtd::detail
