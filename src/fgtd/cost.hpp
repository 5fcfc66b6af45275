// Measured constants of the cost prediction, seconds on one thread: fitted by tools/bench/calibrate to one core of an AMD
// EPYC (Zen 3, AVX2) under g++ 12. On other machines all change by similar factors, and the choice between methods is
// flat: twice a constant costs some ten per cent of time near the break-even and nothing elsewhere. Constants of a method
// mean something together only, since the fit may trade one for another.
#pragma once

namespace fgtd::detail::cost {

constexpr double direct_pair[4] = {1.4e-9, 1.7e-9, 1.8e-9, 1.2e-9};  // one source at one target, by dimension
constexpr double direct_derivative_factor = 3.1;                     // the same with derivatives
constexpr double product_step = 0.014e-9;   // one multiplication and addition in a product of matrices
constexpr double product_call = 510e-9;     // one call of that product
constexpr double moment_step = 0.21e-9;     // one moment of one source
constexpr double moment_number = 6.4e-9;    // one moment of one box: fresh memory
constexpr double contract_step = 0.021e-9;  // one moment at one target, all lanes full
constexpr double hermite_value = 2.2e-9;    // one value of a table of Hermite functions
constexpr double point_sort = 53e-9;        // one source or target brought to its box
constexpr double grid_value = 3.8e-9;       // one value of the result: fresh memory

// The seconds of a search for parameters. The search is left out if the best method so far is faster than that.
constexpr double cells_search = 0.03e-3;
constexpr double outer_product_search = 0.03e-3;
constexpr double spread_search = 0.1e-3;
constexpr double hermite_search = 1e-3;
constexpr double chebyshev_search = 0.3e-3;

// cells and outer, with bench_sharp
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

// chebyshev, with bench_chebyshev
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

// spread, with bench_spread
constexpr double spread_sort = 23e-9;      // one source or target brought to its tile
constexpr double spread_place = 0.36e-9;   // one coefficient of the window's polynomials
constexpr double spread_row = 1.2e-9;      // one vector of the lattice loaded and stored
constexpr double spread_gather = 0.49e-9;  // one vector of the lattice read
constexpr double spread_node = 6.9e-9;     // one node of the lattice: fresh memory
constexpr double spread_step = 0.027e-9;   // one multiplication and addition of the filter
constexpr double spread_entry = 24e-9;     // one value of the filter
constexpr double spread_value = 0.64e-9;   // one value of the result: fresh memory

}  // namespace fgtd::detail::cost
