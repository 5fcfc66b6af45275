// The inner loops. They are plain loops over raw pointers, compiled once for every instruction set (*kernels.cpp) and
// picked at run time. So one program runs on every processor and uses the fastest instructions that it has.
#pragma once

#include <cstddef>

namespace fgtd::detail {

/// Targets are handed to the kernels in groups of this many, padded by repeating one of them.
constexpr std::size_t group_size = 16;

/// The largest dimension of a Plan.
constexpr int max_dimension = 4;

/// Highest derivative_order: no factor overflows up to here.
constexpr int max_derivative_order = 16;

/// Beyond the range of exp(), sigma r^2 > 708, a term counts as 0. This keeps the promise if the polynomial
/// |E_alpha(t)| exp(t^2) is at most tolerance exp(L) = exp(40) / tolerance wherever the term is above the smallest
/// double, up to t^2 = 1500. The polynomial is below 8e16 for orders up to 12, and below 2e21 up to 16.
constexpr int any_tolerance_order = 12;
constexpr double high_order_tolerance = 1e-4;

/// Factors of the recurrence of the scaled Hermite functions h~_n = h_n / sqrt(2^n n!):
///   h~_{n+1}(t) = up[n] t h~_n(t) - back[n] h~_{n-1}(t),   up[n] = sqrt(2/(n+1)), back[n] = sqrt(n/(n+1))
struct Recurrence {
  const double* up;
  const double* back;
};

/// out[q c + k][i] = sum_j weights[k][j] sum_{terms of combination q} coefficient E_alpha(sqrt(sigma) (y_i - x_j)),
/// E_alpha(t) = prod_l h~_{alpha_l}(t_l). The coefficients contain (-1)^|alpha| N_alpha.
struct DirectJob {
  int dimension;
  double sigma;
  double root_sigma;
  std::size_t sources;
  const double* position;  // [dimension][sources]
  std::size_t columns;     // c
  const double* weights;   // [columns][sources]
  std::size_t combinations;
  const std::size_t* first_term;  // [combinations + 1]
  const int* order;               // [terms][max_dimension]: alpha
  const double* coefficient;      // [terms]
  const int* highest;             // [dimension]: largest alpha_l of all terms
  Recurrence recurrence;
  const double* target;  // [dimension][group_size]
  double* out;           // [combinations * columns][group_size], overwritten
};

/// C(rows x width) += B(rows x depth) D(depth x width), all row-major. Rows of D must be readable, not written, up to
/// the next multiple of `row_padding` numbers.
struct ProductJob {
  std::size_t rows, depth, width;
  const double* b;
  std::size_t b_stride;
  const double* d;
  std::size_t d_stride;
  double* c;
  std::size_t c_stride;
};
constexpr std::size_t row_padding = 8;

/// Hermite expansions of some boxes summed at one group of targets:
///   out[a][k][i] += sum_B sum_beta moments_B[k][beta] prod_l g_{alpha_l, beta_l}(sqrt(sigma) (y_i - c_B)_l)
/// over the boxes B within reach of y_i, with g_{a,b}(t) = sqrt(binomial(a+b, a)) h~_{a+b}(t).
struct ExpansionJob {
  int dimension;
  int terms;  // p
  double root_sigma;
  double half_side;      // of a box, times sqrt(sigma)
  double squared_reach;  // boxes whose nearest point is farther (times sigma) count as zero
  std::size_t targets;   // of the group that matter
  const double* target;  // [dimension][group_size]
  std::size_t boxes;
  const std::size_t* box;  // [boxes]
  const double* centre;    // [all boxes][dimension]
  const double* moments;   // [all boxes][columns][p^dimension], first axis fastest
  std::size_t columns;
  std::size_t derivatives;
  const int* order;             // [derivatives][max_dimension]: alpha
  const int* highest;           // [dimension]
  const double* binomial_root;  // [order][p]: sqrt(binomial(a+b, a))
  Recurrence recurrence;
  double* scratch;  // expansion_scratch(...) numbers
  double* out;      // [derivatives][columns][group_size]
};

/// Size of ExpansionJob::scratch for p terms and derivatives up to `highest` in d dimensions.
constexpr std::size_t expansion_scratch(int dimension, int terms, int highest) {
  const std::size_t per_axis = static_cast<std::size_t>(terms + highest) +
                               static_cast<std::size_t>(terms) * static_cast<std::size_t>(highest + 1);
  return static_cast<std::size_t>(dimension) * per_axis * group_size + row_padding;
}

/// rows[n][i] = h~_n(t_i), n = 0 .. orders-1, i = 0 .. count-1; t and the rows are padded to a multiple of row_padding.
struct TableJob {
  std::size_t count;
  int orders;
  const double* t;
  double* rows;
  std::size_t stride;
  Recurrence recurrence;
};

struct CellsJob;  // fgtd/cells/job.hpp
struct OuterProductJob;

/// Brings points begin .. end to a lattice (`spread`): lattice[k][node] += weights[k][j] prod_l phi at the node. With
/// `out` the other way: out[k][j - begin] = sum over nodes of lattice[k][node] prod_l phi. The lattice must be readable
/// and writable up to 16 numbers past every run of w nodes along axis 0; zeros are added there.
struct SpreadJob {
  int dimension;
  int width;                          // w, at most 16
  int degree;                         // of the polynomials
  const double* window;               // [degree + 1][16], fgtd/spread/filter.hpp
  double spacing_high, spacing_low;   // h, the first part with few digits
  double inverse_spacing;             // 1/h
  long long first[max_dimension];     // node of the lattice's corner
  std::size_t stride[max_dimension];  // numbers from node to node
  const double* position;             // [points][dimension], lattice node k at k h
  std::size_t begin, end;
  std::size_t columns;
  const double* weights;  // [columns][weights_stride]
  std::size_t weights_stride;
  double* lattice;  // [columns][lattice_stride]
  std::size_t lattice_stride;
  double* out;  // [columns][out_stride], or null
  std::size_t out_stride;
};

struct LocateJob;  // fgtd/chebyshev/jobs.hpp
struct SortBlockJob;
struct MomentsJob;
struct InterpolateJob;
struct ChainJob;

// Every kernel and its job.
#define FGTD_KERNELS(KERNEL)             \
  KERNEL(direct, DirectJob)              \
  KERNEL(product, ProductJob)            \
  KERNEL(expansion, ExpansionJob)        \
  KERNEL(table, TableJob)                \
  KERNEL(spread, SpreadJob)              \
  KERNEL(cells, CellsJob)                \
  KERNEL(outer_product, OuterProductJob) \
  KERNEL(locate, LocateJob)              \
  KERNEL(sort_block, SortBlockJob)       \
  KERNEL(moments, MomentsJob)            \
  KERNEL(interpolate, InterpolateJob)    \
  KERNEL(chain, ChainJob)

struct Kernels {
  const char* name;
  std::size_t lanes;  // doubles in a vector
#define FGTD_KERNEL(kernel, Job) void (*kernel)(const Job&);
  FGTD_KERNELS(FGTD_KERNEL)
#undef FGTD_KERNEL
};

/// Those of the fastest instruction set that this processor runs.
const Kernels& kernels();

}  // namespace fgtd::detail
