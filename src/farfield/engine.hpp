// The implementation of Plan: checks the arguments, turns every kernel into one of three interactions in units of the
// points' extent, has a method chosen, and gives the results their signs and units.
#pragma once

#include <memory>

#include "farfield/farfield.hpp"
#include "farfield/problem.hpp"

namespace farfield::detail {

template <int d>
class Engine {
 public:
  /// targets: null if the sources are the targets.
  Engine(Kernel kernel, const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Points<d>>* targets,
         const Options& options);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  Values<d> evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds& seconds) const;
  const Choice& choice() const { return choice_; }

 private:
  Options options_;
  Choice choice_;
  int exponent_ = 0;  // of the unit of length, a power of 2
  Problem problem_;
  std::unique_ptr<Summation> summation_;
};

}  // namespace farfield::detail
