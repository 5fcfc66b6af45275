// Sums every pair.
#pragma once

#include "farfield/problem.hpp"

namespace farfield::detail {

struct MethodEntry;  // farfield/catalogue.hpp
MethodEntry direct_method();

class Direct : public Summation {
 public:
  static constexpr std::size_t piece = 128;  // targets; a source serves all of them while it is in the cache

  Direct(const Problem& problem, int threads) : Direct(problem, threads, {0, problem.targets}) {}
  /// Sums at some of the targets; they begin with a piece.
  Direct(const Problem& problem, int threads, Range targets)
      : problem_(problem), threads_(threads), targets_(targets) {}
  void evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const override;
  double evaluation_bytes() const override { return 0; }

 private:
  const Problem& problem_;
  int threads_;
  Range targets_;
};

}  // namespace farfield::detail
