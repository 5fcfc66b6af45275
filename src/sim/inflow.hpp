// What the velocity carries in through a face of the domain: `face` of a source. docs/method.md, section 13.
#pragma once

#include <string>
#include <vector>

#include "expression/expression.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/particles.hpp"
#include "sim/borders/edges.hpp"
#include "sim/scene.hpp"

namespace gaussdrift {

/// A face of the domain in cells as wide as the spacing of the particles. It has one particle a cell and puff.
class Inflow {
 public:
  /// Throws InputError if the velocity comes in nowhere between these elapsed times, as far as a sample tells. The scene
  /// must outlive it.
  Inflow(const Case& spec, const FaceSourceSpec& source, const Scene& scene, double from, double to);

  /// How many cells the face has.
  static std::size_t cells_of(const Case& spec, const FaceSourceSpec& source);

  /// The middles of the cells, with weights 1.
  Particles places() const;

  /// What has come in through each cell between two elapsed times: the integral of the concentration times the velocity
  /// inwards, where it is positive. Throws NumericalError where one of them is not finite.
  std::vector<double> carried_in(double from, double to) const;

  /// "x_min"
  std::string name() const { return face_.name(); }

  /// How fast it comes in at most, as far as a sample of the times tells.
  double fastest() const { return fastest_; }

 private:
  struct Points {
    Particles places;  // some a cell, cell after cell; weights: the areas that they stand for
    std::size_t of_cell = 1;
  };
  Points points(int along) const;
  std::vector<double> inwards(double t, const PointsView& x) const;

  const Scene& scene_;
  TimeSpec clock_;
  Domain domain_;
  Face face_;
  Expression concentration_;
  double spacing_;
  double fastest_ = 0;
};

}  // namespace gaussdrift
