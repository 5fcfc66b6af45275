// Constants of chebyshev, with bench_chebyshev: see fgtd/cost.hpp.
#pragma once

#include "fgtd/cost.hpp"

namespace fgtd::detail::cost {

constexpr double chebyshev_search = 0.3e-3;
constexpr double chebyshev_sort = 54e-9;            // one source or target brought to its box
constexpr double chebyshev_sort_far = 30e-9;        // the same more where the points exceed the cache
constexpr double chebyshev_sort_cache = 3e5;        // points that it keeps
constexpr double chebyshev_spread = 12e-9;          // the same more, for every tenfold of boxes above 100
constexpr double chebyshev_basis = 0.38e-9;         // one value of a Lagrange polynomial
constexpr double chebyshev_step = 0.13e-9;          // one multiplication and addition at a point, all lanes full
constexpr double chebyshev_number = 14e-9;          // one moment of one box: fresh memory
constexpr double chebyshev_value = 3.1e-9;          // one result brought to its place
constexpr double chebyshev_product = 0.054e-9;      // one multiplication and addition between boxes, all lanes full
constexpr double chebyshev_contraction = 65e-9;     // one axis of one box of targets, or of one group of nodes
constexpr double chebyshev_call = 4.2e-9;           // one product of matrices
constexpr double chebyshev_link = 2.6e-9;           // one box in it
constexpr double chebyshev_fetch = 0.35e-9;         // one number of it, if all boxes exceed the cache
constexpr double chebyshev_cache = 550000;          // numbers that the cache keeps
constexpr double chebyshev_table = 8.4e-9;          // one value of the Gaussian between nodes
constexpr double chebyshev_block_sort = 12e-9;      // few boxes: one point brought to its box within a block
constexpr double chebyshev_block_basis = 0.68e-9;   // one value of a polynomial there
constexpr double chebyshev_block_run = 270e-9;      // the points of one box in one block
constexpr double chebyshev_block_moment = 0.08e-9;  // one coefficient of one source
constexpr double chebyshev_block_value = 0.063e-9;  // one coefficient at one target

}  // namespace fgtd::detail::cost
