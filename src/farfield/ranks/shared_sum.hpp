// Sums whose points are on several ranks, as the methods prepare them.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "farfield/near/direct.hpp"
#include "farfield/ranks/homes.hpp"

namespace farfield::detail {

/// Brings charges to the ranks that own their points, and results home.
template <int d>
class SharedSum : public Summation {
 public:
  SharedSum(const Channel& channel, std::unique_ptr<Homes<d>> homes, std::unique_ptr<Summation> own, bool potential)
      : channel_(channel), homes_(std::move(homes)), own_(std::move(own)), potential_(potential) {}
  void evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const override;
  double evaluation_bytes() const override;

 private:
  const Channel& channel_;
  const std::unique_ptr<Homes<d>> homes_;
  const std::unique_ptr<Summation> own_;
  const bool potential_;
};

/// Every pair: all ranks have all sources, and each sums at some of the targets.
template <int d>
class SharedDirect : public Summation {
 public:
  SharedDirect(const Channel& channel, const Problem& problem, std::span<const std::int64_t> numbers, int threads,
               Received& received);
  void evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const override;
  double evaluation_bytes() const override;

 private:
  /// The targets that a rank sums at, in the order of numbers.
  Range targets_of(std::size_t rank) const;

  const Channel& channel_;
  Problem all_;
  std::vector<std::vector<Index>> place_;  // [rank][point]: among the points of all, in the order of numbers
  const int threads_;
};

}  // namespace farfield::detail
