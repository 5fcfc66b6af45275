// Sums every pair.
#pragma once

#include "farfield/problem.hpp"

namespace farfield::detail {

class Direct : public Summation {
 public:
  Direct(const Problem& problem, int threads) : problem_(problem), threads_(threads) {}
  void evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const override;
  double evaluation_bytes() const override { return 0; }

 private:
  const Problem& problem_;
  int threads_;
};

}  // namespace farfield::detail
