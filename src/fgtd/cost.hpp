// Measured constants of the cost prediction, seconds on one thread. Measured with tools/bench (bench_direct,
// bench_hermite) on one core of an AMD EPYC (Zen 4, AVX-512) under g++ 12; on other machines all change by similar
// factors, and the choice between methods is flat: twice a constant costs some ten per cent of time near the break-even
// and nothing elsewhere.
#pragma once

namespace fgtd::detail::cost {

constexpr double direct_pair[4] = {0.9e-9, 1.0e-9, 1.1e-9, 1.2e-9};  // one source at one target, by dimension
constexpr double direct_derivative_factor = 2.5;                     // the same with derivatives
constexpr double product_step = 0.08e-9;   // one multiplication and addition in a product of matrices
constexpr double product_call = 60e-9;     // one call of that product
constexpr double moment_step = 0.12e-9;    // one moment of one source
constexpr double moment_number = 4e-9;     // one moment of one box: fresh memory
constexpr double contract_step = 0.06e-9;  // one moment at one target, all lanes full
constexpr double hermite_value = 0.2e-9;   // one value of a table of Hermite functions
constexpr double point_sort = 30e-9;       // one source or target brought to its box
constexpr double grid_value = 2e-9;        // one value of the result: fresh memory

}  // namespace fgtd::detail::cost
