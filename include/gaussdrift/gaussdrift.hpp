/// @file
/// The simulator as a library: read a case, run it, look at its frames. docs/library.md.
#pragma once

#include "gaussdrift/accuracy.hpp"
#include "gaussdrift/case.hpp"
#include "gaussdrift/error.hpp"
#include "gaussdrift/frame.hpp"
#include "gaussdrift/read_case.hpp"
#include "gaussdrift/simulation.hpp"
#include "gaussdrift/summary.hpp"
