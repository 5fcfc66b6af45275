// Outputs of a run as Python sees them.
#pragma once

#include <pybind11/pybind11.h>

#include "gaussdrift/frame.hpp"
#include "gaussdrift/summary.hpp"

namespace gaussdrift::python {

/// What the frame points at, copied into arrays that Python owns.
pybind11::dict dict_of(const Frame& frame);
/// Numbers, checks and seconds of a run, and its series: a list for each column.
pybind11::dict dict_of(const RunSummary& summary);

}  // namespace gaussdrift::python
