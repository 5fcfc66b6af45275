// The one-dimensional parts of `spread`. In units in which the Gaussian is exp(-t^2), with a lattice of nodes x_k = k H,
//   h~_a(y - x) = sum_k phi((x - x_k)/H) f_a(y - x_k)                                    targets anywhere: grids
//   h~_a(y - x) = sum_k sum_m phi((x - x_k)/H) F_a(x_m - x_k) phi((y - x_m)/H)            scattered targets
// up to the error measured here. phi is the Kaiser-Bessel window of w nodes, I_0(b sqrt(1 - (2s/w)^2)) / I_0(b),
// whose transform is known, phi^(q) = w sinh(r)/(r I_0(b)), r^2 = b^2 - (q w/2)^2; f and F are those of the orthogonal
// projection onto the lattice's functions,
//   f^(q) = g^(q) phi^(qH) / P(qH),   F^ = f^ phi^ / P,   P(q) = sum_m phi^(q + 2 pi m)^2,   g^(q) = sqrt(pi) e^{-q^2/4},
// which, unlike a plain quotient g^/phi^ cut off somewhere, leaves no slowly fading tail.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "core/buffer.hpp"

namespace fgtd::detail {

constexpr int smallest_window = 3, largest_window = 16;  // w

/// What has to agree between the filters of one lattice: w, b, and the degree of the polynomials for phi.
struct SpreadWindow {
  int width;
  double shape;
  int degree;

  /// That serves for a tolerance.
  static SpreadWindow of(int width, double tolerance);
};

/// phi, f and F for one window, spacing and highest derivative.
class SpreadFilter {
 public:
  /// spacing H.
  /// @param grids  whether f is wanted too, beside F: targets that are not on the lattice
  SpreadFilter(const SpreadWindow& window, double spacing, int derivative_order, double tolerance, bool grids = true);

  int width() const { return width_; }                                            // w
  double spacing() const { return spacing_; }                                     // H
  double reach() const { return reach_; }                                         // f_a(t) = 0 for |t| > reach
  int lattice_reach() const { return static_cast<int>(lattice_[0].size()) - 1; }  // F_a(j H) = 0 for |j| > this

  /// phi at the w nodes around a point: with theta in [0, 1) the distance to the first of them less -w/2, node j is at
  /// s = j - w/2 + theta, and phi(s) = sum_i coefficient[i][j] (2 theta - 1)^i. Rows are padded by zeros.
  int degree() const { return degree_; }
  const double* coefficients() const { return coefficients_.data(); }  // [degree + 1][padded_window]
  static constexpr std::size_t padded_window = 16;

  double window(double s) const;              // phi(s)
  double filter(int a, double t) const;       // f_a(t)
  double lattice_filter(int a, int j) const;  // F_a(j H)

  /// Largest error of a product over d axes relative to N_alpha, |alpha| <= derivative_order: prod (1 + E_a) - 1, E_a
  /// that of one axis on a mesh, times `mesh_safety`. Infinite if the product does not fade as promised.
  double grid_error(int d) const { return product_error(grid_axis_, d); }
  double point_error(int d) const { return product_error(point_axis_, d); }

 private:
  struct AxisError {
    std::vector<double> error;  // E_a
    double excess = 0;          // max_t ln(|sum| e^{t^2})
  };
  struct Samples {
    std::size_t panels;
    std::vector<std::vector<double>> at;  // [order + 1][panels of width H][filter_terms], f_a at the Chebyshev points
  };
  void make_window();
  double window_transform(double q) const;  // phi^
  void make_filters();
  /// f_a at the points of the panels, and F_a in lattice_, by the trapezoidal rule with steps of q.
  Samples integrate(std::size_t panels, double step);
  /// Sets the reach, and the panels within it as polynomials.
  void cut_filters(const Samples& samples);
  AxisError measure_grid() const;
  AxisError measure_points() const;
  double product_error(const AxisError& axis, int d) const;
  void window_at(double theta, double* values) const;

  int width_, degree_;
  double spacing_, shape_, top_, tolerance_;  // top: I_0(b)
  int order_;
  bool grids_;
  double reach_ = 0;
  gaussdrift::core::Buffer<double> coefficients_;
  std::vector<std::vector<double>> filter_;   // [order + 1][panels of width H][filter_terms], t >= 0
  std::vector<std::vector<double>> lattice_;  // [order + 1][j]
  AxisError grid_axis_, point_axis_;
};

/// The spacing that a window of w nodes should allow, before anything is measured.
double expected_spacing(int width, int derivative_order, double tolerance);

/// The window of w nodes on the widest lattice that keeps the tolerance in d dimensions, for grids and for scattered
/// targets; none if it cannot. Remembered: made once for every different call.
std::shared_ptr<const SpreadFilter> find_filter(int d, int width, int derivative_order, double tolerance);

/// The filter without f for a window and a spacing, whether it keeps the tolerance or not. Remembered as well.
std::shared_ptr<const SpreadFilter> lattice_filter(const SpreadWindow& window, double spacing, int derivative_order,
                                                   double tolerance);

}  // namespace fgtd::detail
