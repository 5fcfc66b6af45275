// All that interpolation of a given accuracy needs and that does not depend on the points: degrees, couplings of all
// offsets, and the transfer from a cluster to its parent. Lengths are in sides of the cluster, so one set serves every
// level.
#pragma once

#include <memory>
#include <vector>

#include "farfield/interpolation/coupling.hpp"
#include "farfield/interpolation/interpolation.hpp"

namespace farfield::detail {

/// Degrees of interpolation by the measured table, for an error of one charge at one target in the measure of the
/// promise.
template <int d>
struct Degrees {
  /// The tolerable error, for two clusters and where one side alone is interpolated; at least smallest_error().
  Degrees(double tolerable, double tolerable_one_sided);
  static double smallest_error();

  /// The degree for clusters |k_l| apart; 0 if they touch.
  int between(const int* k) const { return at_offset[octant_number<d>(k)]; }

  double error = 0;            // the largest of two clusters, at most the tolerable
  double one_sided_error = 0;  // the same where one side alone is interpolated
  int highest = 1;
  int one_sided = 1;
  int at_offset[octant_offsets<d>] = {};

  bool operator==(const Degrees&) const = default;
};

template <int d>
class Operators {
 public:
  static constexpr std::size_t octants = std::size_t{1} << d;

  /// Equal degrees share one set as long as somebody holds it.
  static std::shared_ptr<const Operators> get(const Degrees<d>& degrees, bool couplings, int threads);
  Operators(const Degrees<d>& degrees, bool couplings, int threads);

  /// Highest degree; moments and coefficients of every cluster have it.
  int degree() const { return degrees_.highest; }
  std::size_t functions() const { return detail::functions<d>(degrees_.highest); }

  /// For clusters whose other side are points; of a degree of its own.
  const Interpolation<d>& one_sided() const { return *one_sided_; }

  /// Between clusters |k_l| apart; empty unless asked for.
  const Coupling& coupling(const int* k) const { return coupling_[octant_number<d>(k)]; }
  /// Bit l is set if k_l is negative.
  static std::size_t reflection(const int* k) {
    std::size_t s = 0;
    for (std::size_t l = 0; l < d; ++l) s |= static_cast<std::size_t>(k[l] < 0) << l;
    return s;
  }
  /// Moments and coefficients are kept by parity, ascending within each, so that a Coupling::Run is one piece.
  std::size_t place(std::size_t function) const { return place_[function]; }
  std::size_t first_of(unsigned parity) const { return first_of_[parity]; }
  /// Numbers kept by parity in the order of harmonics.hpp.
  void in_order(const double* kept, double* ordered) const {
    for (std::size_t k = 0; k < place_.size(); ++k) ordered[k] = kept[place_[k]];
  }

  /// Polynomials of the parent in those of the child in octant o: h_k(parent) = sum_m transfer[m][k] h_m(child); by
  /// parity.
  const double* transfer(std::size_t octant) const { return transfer_[octant].data(); }
  /// The same as [k][m].
  const double* transposed(std::size_t octant) const { return transposed_[octant].data(); }

  /// Factors of the recurrence, as MomentsJob wants them; 3D.
  const double* up() const { return up_.data(); }
  const double* back() const { return back_.data(); }

 private:
  void make_transfer(const Interpolation<d>& interpolation);

  Degrees<d> degrees_;
  std::unique_ptr<Interpolation<d>> one_sided_;
  std::vector<Coupling> coupling_;
  Buffer<double> transfer_[octants], transposed_[octants];
  std::vector<std::size_t> place_;
  std::size_t first_of_[octants] = {};
  std::vector<double> up_, back_;
};

}  // namespace farfield::detail
