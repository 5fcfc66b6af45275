// Method `chebyshev`, for wide Gaussians: boxes with P Chebyshev nodes an axis. Between the nodes of two boxes the
// Gaussian is a product over the axes (docs/fgtd.md).
//   s_alpha(y) = (-1)^|alpha| N_alpha sum_m prod_l l_{m_l}(y_l) B_m,   A_n = sum_j lambda_j prod_l l_{n_l}(x_jl)
//   B_m        = sum_boxes sum_n A_n prod_l h~_{alpha_l}(sqrt(sigma) (y_m - x_n)_l)
// with the Lagrange polynomials l of the nodes y_m of the target's box and x_n of the sources' boxes. On a tensor grid
// the y_m are the grid's nodes themselves. The sums over boxes and nodes are taken one axis after the other, last axis
// first.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "fgtd/chebyshev/blocks.hpp"
#include "fgtd/chebyshev/lattice.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/request.hpp"
#include "fgtd/summation.hpp"

namespace fgtd::detail {

struct MethodEntry;

struct AxisMatrices;  // fgtd/chebyshev/matrices.hpp

template <int d>
struct ChebyshevPlan {
  int nodes = 0;     // P
  double reach = 0;  // R: boxes farther apart on some axis (times sqrt(sigma)) do not see each other
  BoxLattice<d> lattice;
  bool few_boxes = false;  // all are kept, see fgtd/chebyshev/blocks.hpp
};

template <int d>
class ChebyshevSum : public Summation<d> {
 public:
  /// position [d][sources]
  ChebyshevSum(const ChebyshevPlan<d>& plan, double sigma, Buffer<double> position, int threads);

  void set_weights(const double* weights, std::size_t columns) override;  // computes the moments
  void evaluate(const Request<d>& request, const double* targets, std::size_t count, double* values) const override;
  void evaluate(const Request<d>& request, const TensorGrid& grid, double* values) const override;

  double plan_bytes(std::size_t columns) const override;
  double point_bytes(const Request<d>& request, std::size_t count) const override;
  double grid_bytes(const Request<d>& request, const TensorGrid& grid) const override;
  void count(Choice& choice) const override { std::get<Chebyshev>(choice.parameters).boxes = sources_.box.size(); }

 private:
  class Translation;

  /// Boxes whose indices differ by more than this on axis l do not see each other.
  std::int64_t neighbours(std::size_t l) const;
  std::size_t box_numbers() const { return box_numbers_; }
  /// All boxes of sources.
  BoxRange<d> source_range() const;
  void sum_moments(const double* weights);
  double sum_over_boxes(std::size_t results) const;
  std::array<AxisMatrices, d> matrices_between_boxes(const Request<d>& request) const;
  /// Numbers at the nodes of the boxes begin .. end of a tree (first axis fastest; last axis slowest):
  /// coefficients[box - begin][outputs][P^d], overwritten.
  void translate(const Request<d>& request, const std::array<AxisMatrices, d>& matrices,
                 const std::array<BoxLevel, d>& tree, std::size_t begin, std::size_t end, double* coefficients) const;
  /// Targets beyond the boxes least .. most are out of reach.
  void evaluate_few(const Request<d>& request, const BoxRange<d>& range, const BoxIndex<d>& least,
                    const BoxIndex<d>& most, const double* targets, std::size_t count, double* values) const;
  /// Targets beyond the range are out of reach.
  void evaluate_block(const Request<d>& request, const BoxRange<d>& range, const double* targets, std::size_t count,
                      double* values, std::size_t stride) const;

  ChebyshevPlan<d> plan_;
  double sigma_;
  int threads_;
  std::vector<double> node_, scale_;  // of the Lagrange polynomials
  std::size_t box_numbers_;           // P^d
  Buffer<double> position_;           // of the sources, [d][sources]; with few boxes, else empty
  SortedPoints<d> sources_;           // first axis slowest; with few boxes only their list
  std::array<BoxLevel, d> tree_;
  std::size_t columns_ = 0;
  Buffer<double> moments_;  // [boxes][columns][P^d], first axis fastest
};

/// The method `chebyshev` for the catalogue.
MethodEntry chebyshev_method();

}  // namespace fgtd::detail
