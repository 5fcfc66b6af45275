// Where memory runs out: one line and exit code 3, wherever it happens, before main and where nothing may be thrown too.
#pragma once

#include "gaussdrift/error.hpp"

namespace gaussdrift::cli {

/// Says that memory has run out, without taking any. The code to end with.
ExitCode out_of_memory();

}  // namespace gaussdrift::cli
