// The kernels of sum_gaussian_pairs() for every processor of the architecture.
#define FGTD_ISA baseline
#define FGTD_LANES 2
#include "field/gaussians/pairs_body.hpp"
