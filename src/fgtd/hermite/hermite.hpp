// The thesis's algorithm [Sch06, ch. 3]: moments of boxes, and Hermite functions of the neighbour boxes at the targets.
//   s_alpha(y) = (-1)^|alpha| N_alpha sum_{boxes B} sum_{beta < p} A_beta(B) g_{alpha,beta}(sqrt(sigma) (y - c_B))
//   A_beta(B)  = sum_{x_j in B} lambda_j prod_l (sqrt(2 sigma) (x_j - c_B)_l)^{beta_l} / sqrt(beta_l!)
//   g_{a,b}(t) = sqrt(binomial(a+b, a)) h~_{a+b}(t),   h~_n = h_n / sqrt(2^n n!)
// which is (3.3) with both factors scaled so that they stay of size one whatever the order.
#pragma once

#include <limits>
#include <vector>

#include "core/buffer.hpp"
#include "fgtd/boxes.hpp"
#include "fgtd/direct/sum.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/request.hpp"
#include "fgtd/summation.hpp"

namespace fgtd::detail {

struct MethodEntry;

using gaussdrift::core::Buffer;

/// r, p, n with the distance beyond which a box is left out.
struct HermitePlan {
  double box_scale = 0;                                    // r
  int terms = 0;                                           // p
  int neighbours = 0;                                      // n, or HermiteParameters::all_boxes
  double reach = std::numeric_limits<double>::infinity();  // times sqrt(sigma); infinite if n alone decides
};

template <int d>
class HermiteSum : public Summation<d> {
 public:
  /// position [d][count] of sources whose boxes have the side `side`.
  HermiteSum(const HermitePlan& plan, double sigma, double side, Buffer<double> position, std::size_t count,
             int threads);

  void set_weights(const double* weights, std::size_t columns) override;  // computes the moments
  void evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const override;
  void evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const override;

  double plan_bytes(std::size_t columns) const override;
  double point_bytes(const Request<d>& request, std::size_t count) const override;
  double grid_bytes(const Request<d>& request, const TensorGrid& grid) const override;
  void count(Choice& choice) const override { std::get<Hermite>(choice.parameters).boxes = boxes_.count(); }

 private:
  HermitePlan plan_;
  double sigma_;
  int threads_;
  Sources<d> sources_;              // sorted by box
  std::vector<std::size_t> order_;  // sorted source j is the caller's order_[j]
  Boxes<d> boxes_;
  std::size_t columns_ = 0;
  std::vector<double> moments_;  // [boxes][columns][p^d], first axis fastest
};

/// g_{a,b} needs sqrt(binomial(a+b, a)), a = 0 .. highest, b = 0 .. terms-1: table[a][b].
std::vector<double> binomial_roots(int highest, int terms);

/// p^n
std::size_t power(int p, int n);

/// The method `hermite` for the catalogue.
MethodEntry hermite_method();

}  // namespace fgtd::detail
