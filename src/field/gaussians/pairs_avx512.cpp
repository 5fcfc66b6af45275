// The kernels of sum_gaussian_pairs() for x86-64 with AVX-512.
#define FGTD_ISA avx512
#define FGTD_LANES 8
#include "field/gaussians/pairs_body.hpp"
