// A preconditioner for large systems of interpolation: overlapping domains with coarser and coarser sets of points
// [BLB00]. On every level the points are cut into parts. For each part the equations of the points around it are solved,
// and the weights of its own points are kept: rows of an inverse matrix, stored. What is left of the values at some
// points of each part goes to the next level. The last level is solved exactly.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "rbf/fit/dense_system.hpp"

namespace rbf::detail {

struct SchwarzParameters {
  Eigen::Index own = 64;      // points of a part, at most
  Eigen::Index around = 200;  // points of its equations
  Eigen::Index coarse = 4;    // points of a part that go to the next level
  Eigen::Index dense = 2000;  // points of the last level, at most
  double tolerance = 1e-6;    // of the sums between levels
};

template <int d>
class Schwarz {
 public:
  Schwarz(const Function& function, const Points<d>& points, int order, double ridge, const SchwarzParameters& how,
          int threads, std::size_t memory_limit);
  ~Schwarz();

  /// Weights, orthogonal to the polynomials, and coefficients of the polynomials of frame().
  Coefficients solve(const Eigen::VectorXd& values) const;
  const Frame<d>& frame() const { return frame_; }

  /// 1/condition of the worst of the parts and the last level; 0: one of them is not definite to rounding.
  double reciprocal_condition() const { return reciprocal_; }
  /// Errors of the values at each point, as the others around it predict it.
  Eigen::VectorXd left_out(const Eigen::VectorXd& values) const;

  static double bytes(Eigen::Index count, const SchwarzParameters& how);

 private:
  struct Part {
    std::vector<Eigen::Index> own, around;
    Eigen::MatrixXd rows;  // weights of own from values around
    Eigen::VectorXd diagonal;
  };
  Eigen::VectorXd gathered(const Part& part, const Eigen::VectorXd& values) const;

  Function function_;
  Points<d> points_;
  Frame<d> frame_;
  int threads_;
  double reciprocal_ = 1;
  std::optional<DenseSystem> dense_;  // the last level
  std::vector<Part> parts_;
  Eigen::MatrixXd polynomials_;  // orthonormal
  std::vector<Eigen::Index> coarse_;
  std::unique_ptr<Schwarz> next_;
  std::unique_ptr<Plan<d>> sum_;  // to the coarse points
};

}  // namespace rbf::detail
