// The blobs of some particles as sums of Gaussians that fgtd computes, in d = 2 or 3 dimensions. The Gaussians lie in a
// space of e dimensions: e = d, but for those on a sphere (particle/chord.hpp), whose places are d = 2 numbers each.
#pragma once

#include <fgtd/fgtd.hpp>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <span>
#include <type_traits>
#include <vector>

#include "gaussdrift/lattice_pieces.hpp"
#include "gaussdrift/particles.hpp"
#include "particle/chord.hpp"
#include "particle/cutoff.hpp"
#include "particle/round_coordinates.hpp"
#include "sim/transform.hpp"

namespace gaussdrift {

template <int d, int e = d>
class BlobSum {
 public:
  /// Copies what it needs of the particles. The options must outlive it. Throws InputError for an unknown method.
  BlobSum(const Particles& particles, const Cutoff& cutoff, const DensityOptions& options);

  /// The largest error that a tolerance of 1 in each term gives, anywhere: fgtd promises tolerance * N * weight around.
  /// For the particles that this was made of.
  OfQuantities error_of_unit_tolerance(const Particles& particles) const;

  /// Sets the tolerance a term with which errors stay below options.tolerance * maxima, and reports it.
  void choose_tolerance(const OfQuantities& unit_errors, const OfQuantities& maxima, DensityReport& report);

  /// What transform() would take.
  DensityWork predict(const fgtd::TensorGrid& grid) const;

  /// The density on a grid and, in further columns, its derivatives. Reports what fgtd chose.
  Eigen::MatrixXd transform(const fgtd::TensorGrid& grid, DensityReport& report) const;

  /// The same at some points, pair by pair.
  Eigen::MatrixXd direct(const fgtd::Points<d>& targets) const;

  /// The largest errors of `values` on the points of a box, one quantity after the other, at the points with these
  /// numbers within it.
  OfQuantities largest_errors(const Lattice& lattice, const LatticeBox& box, const std::vector<double>& values,
                              const std::vector<std::size_t>& numbers) const;

  /// Lower bounds of the maxima, from these points; derivatives also from points beside them, where a blob has its
  /// largest slope.
  OfQuantities largest_near(const fgtd::Points<d>& points) const;

  /// Number of particles.
  std::size_t size() const { return static_cast<std::size_t>(sources_.cols()); }
  const fgtd::Points<d>& sources() const { return sources_; }

 private:
  // All terms of one Gaussian width: one prepared transform, evaluated with derivatives. That of ellipses is one in
  // coordinates in which they are round, and that of a sphere one in space.
  struct WidthGroup {
    double sigma = 0;                                // 1 / width^2
    std::optional<RoundCoordinates> round = {};      // of ellipses
    double sphere = 0;                               // its radius, where e is not d
    std::vector<fgtd::Combination<e>> combinations;  // of each quantity
    int derivative_order = 0;
    OfQuantities scale;  // sum |c_alpha| N_alpha, the largest value of the combination for a unit weight

    fgtd::Points<e> in_its_coordinates(const fgtd::Points<d>& points) const;
    // The grid, as long as it is one there.
    std::optional<fgtd::TensorGrid> in_its_coordinates(const fgtd::TensorGrid& grid) const;
    // Where a Gaussian is steepest on the way along an axis.
    double steepest_at(std::size_t axis) const;
  };
  static std::vector<WidthGroup> group_by_width(const Cutoff& cutoff, const std::vector<DensityDerivatives>& wanted);
  bool by_hand() const { return options_.method == to_string(fgtd::Method::hermite) && options_.hermite; }
  // Bound (3.5) of the error of the sum with parameters by hand.
  double bound_by_hand(std::size_t quantity) const;
  class Targets;
  fgtd::Plan<e> plan_of(const WidthGroup& group, const fgtd::Options& options) const;
  fgtd::Options options_for(const WidthGroup& group) const;

  const DensityOptions& options_;
  fgtd::Points<d> sources_;
  Eigen::MatrixXd weights_;
  std::vector<WidthGroup> groups_;
  double tolerance_ = 0;
};

/// Calls use(d, e), two std::integral_constants: the dimensions of places, and of the space of these Gaussians.
template <class Use>
decltype(auto) in_dimensions(int dimension, const Cutoff& cutoff, const Use& use) {
  constexpr std::integral_constant<int, 2> plane;
  constexpr std::integral_constant<int, 3> space;
  if (dimension == 3) return use(space, space);
  return sphere_of(cutoff) > 0 ? use(plane, space) : use(plane, plane);
}

/// All of a lattice.
inline LatticeBox whole(const Lattice& lattice) { return {.first = {}, .points = lattice.points}; }

/// The points of a box.
fgtd::TensorGrid nodes_of(const Lattice& lattice, const LatticeBox& box);

/// The number of the largest |value|, the first of several.
std::size_t number_of_largest(std::span<const double> values);

/// count - 1 numbers below `size`, spread evenly however many there are, to be looked at beside that of the largest
/// value.
std::vector<std::size_t> spread_numbers(std::size_t size, std::size_t count);

}  // namespace gaussdrift
