// The kernels of sum_gaussian_pairs() for x86-64 with AVX2 and FMA.
#define FGTD_ISA avx2
#define FGTD_LANES 4
#include "field/gaussians/pairs_body.hpp"
