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
  Choice choice;          // method, bound, cost, seconds, parameters; `boxes` is filled in later
  double plan_bytes = 0;  // predicted
  std::function<std::unique_ptr<Summation<d>>(Buffer<double> position)> make;  // position [d][N]
};

// One function for each method. Its result is empty if the method cannot keep the promise here, or would need more
// memory than allowed.

template <int d>
Proposal<d> propose_direct(const Situation<d>& at);
/// Throws MemoryLimitError if Method::hermite is asked for and no parameters fit the limit.
template <int d>
std::optional<Proposal<d>> propose_hermite(const Situation<d>& at);
/// Throws MemoryLimitError as propose_hermite().
template <int d>
std::optional<Proposal<d>> propose_chebyshev(const Situation<d>& at);
/// For scattered targets, unless asked for; throws MemoryLimitError as propose_hermite().
template <int d>
std::optional<Proposal<d>> propose_cells(const Situation<d>& at);
/// For grids, unless asked for; throws MemoryLimitError as propose_hermite().
template <int d>
std::optional<Proposal<d>> propose_outer(const Situation<d>& at);
/// Throws MemoryLimitError as propose_hermite().
template <int d>
std::optional<Proposal<d>> propose_spread(const Situation<d>& at);

/// The proposal of the method that is asked for, or the cheapest for Method::automatic. `direct` replaces a method that
/// cannot serve here (no sources, or boxes that coordinates cannot tell apart). position [d][count].
template <int d>
Proposal<d> choose(const Buffer<double>& position, std::size_t count, std::size_t columns, double sigma,
                   const Options& options);

}  // namespace fgtd::detail
