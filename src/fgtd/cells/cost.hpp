// Constants of cells and outer, with bench_sharp: see fgtd/cost.hpp.
#pragma once

#include "fgtd/cost.hpp"

namespace fgtd::detail::cost {

constexpr double cells_search = 0.03e-3;
constexpr double outer_product_search = 0.03e-3;
constexpr double cells_source_sort = 49e-9;                      // one source brought to its cell
constexpr double cells_target_sort = 24e-9;                      // one target brought to its cell, and its result back
constexpr double cells_pair[4] = {0.68e-9, 1e-9, 1.1e-9, 1e-9};  // one source at one target, by dimension
constexpr double cells_derivative_factor = 3.7;                  // the same with derivatives
constexpr double cells_column = 0.1;                             // one more column of weights, in pairs
constexpr double cells_line = 26e-9;                             // one line of cells looked at for a group of targets
constexpr double outer_product_source_sort = 76e-9;              // one source of few brought to its cell
constexpr double outer_product_group = 26e-9;                    // one group of sources
constexpr double outer_product_table = 1.4e-9;                   // one value of a row
constexpr double outer_product_step = 0.069e-9;                  // one multiplication and addition of rows
constexpr double outer_product_update = 0.1e-9;                  // one node loaded and stored
constexpr double outer_product_row = 0.69e-9;                    // one factor of the second axis
constexpr double outer_product_value = 0.38e-9;                  // one value of the result set to zero

}  // namespace fgtd::detail::cost
