// Constants of spread, with bench_spread: see fgtd/cost.hpp.
#pragma once

#include "fgtd/cost.hpp"

namespace fgtd::detail::cost {

constexpr double spread_search = 0.1e-3;
constexpr double spread_sort = 23e-9;      // one source or target brought to its tile
constexpr double spread_place = 0.36e-9;   // one coefficient of the window's polynomials
constexpr double spread_row = 1.2e-9;      // one vector of the lattice loaded and stored
constexpr double spread_gather = 0.49e-9;  // one vector of the lattice read
constexpr double spread_node = 6.9e-9;     // one node of the lattice: fresh memory
constexpr double spread_step = 0.027e-9;   // one multiplication and addition of the filter
constexpr double spread_entry = 24e-9;     // one value of the filter
constexpr double spread_value = 0.64e-9;   // one value of the result: fresh memory

}  // namespace fgtd::detail::cost
