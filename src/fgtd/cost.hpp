// Measured constants of the cost prediction, seconds on one thread: fitted by tools/bench/calibrate to one core of an AMD
// EPYC (Zen 3, AVX2) under g++ 12. On other machines all change by similar factors, and the choice between methods is
// flat: twice a constant costs some ten per cent of time near the break-even and nothing elsewhere. Constants of a method
// mean something together only, since the fit may trade one for another. Those of one method alone stand in its folder.
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

// A search for parameters takes ..._search seconds. It is left out if the best method so far is faster than that.
constexpr double hermite_search = 1e-3;

}  // namespace fgtd::detail::cost
