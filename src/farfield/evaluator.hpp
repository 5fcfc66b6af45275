// What stands behind a Plan.
#pragma once

#include "farfield/farfield.hpp"

namespace farfield::detail {

template <int d>
class Evaluator {
 public:
  virtual ~Evaluator() = default;
  virtual Values<d> evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds& seconds) const = 0;
  virtual const Choice& choice() const = 0;
  virtual Received received() const { return {}; }
};

}  // namespace farfield::detail
