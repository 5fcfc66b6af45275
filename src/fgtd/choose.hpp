// Chooses among the methods. Each method makes a proposal: the cheapest parameters that are proven to keep the
// tolerance, a prediction of the cost, and a function that makes the sum. The cheapest proposal is taken.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "core/buffer.hpp"
#include "fgtd/fgtd.hpp"
#include "fgtd/situation.hpp"
#include "fgtd/summation.hpp"

namespace fgtd::detail {

using gaussdrift::core::Buffer;

template <int d>
struct Proposal {
  Choice choice;          // what is counted when the sum is made is filled in then: Summation::count()
  double plan_bytes = 0;  // predicted
  std::function<std::unique_ptr<Summation<d>>(Buffer<double> position)> make;  // position [d][N]
};

template <int d>
using Proposer = std::optional<Proposal<d>> (*)(const Situation<d>& at);

/// The proposal of the method that is asked for, or the cheapest for Method::automatic. `direct` replaces a method that
/// cannot serve here (no sources, or boxes that coordinates cannot tell apart). position [d][count].
template <int d>
Proposal<d> choose(const Buffer<double>& position, std::size_t count, std::size_t columns, double sigma,
                   const Options& options);

}  // namespace fgtd::detail
