// The kernels for every processor of the architecture.
#define FGTD_ISA baseline
#define FGTD_LANES 2
#include "fgtd/kernels_body.hpp"
