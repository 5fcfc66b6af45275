// The kernels for x86-64 with AVX-512 (F, DQ, VL).
#define FGTD_ISA avx512
#define FGTD_LANES 8
#include "fgtd/kernels_body.hpp"
