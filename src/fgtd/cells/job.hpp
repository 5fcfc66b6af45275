// The arguments of the kernels of `cells` and `outer_product`: pair sums over runs of sources, and outer products of rows.
#pragma once

#include <cstddef>

#include "fgtd/kernels/kernels.hpp"

namespace fgtd::detail {

/// 2^-s for s >= 0 comes from a polynomial of 2^r, |r| <= 1/2, of one of these degrees, interpolated at the Chebyshev
/// points; its largest relative error beside it. The last is exact up to rounding.
struct Exponential {
  int degree;
  double error;
};
constexpr Exponential exponentials[] = {{4, 3.6e-6}, {6, 2.6e-9}, {8, 1.2e-12}, {11, 0}};

constexpr double log2_e = 1.4426950408889634;

/// Arrays of targets must be readable, and arrays of results writable, this many numbers beyond their end.
constexpr std::size_t target_padding = 8;

/// Targets first .. first + targets - 1, which share the runs of sources first_run .. end_run - 1.
struct CellsGroup {
  std::size_t first, targets;
  std::size_t first_run, end_run;
};

/// out[q c + k][i] = sum over the runs of sources of target i of weights[k][j] times combination q of E_alpha(t),
/// |t| <= reach, as in DirectJob.
struct CellsJob {
  int dimension;
  int degree;  // of the exponential
  double sigma;
  double root_sigma;
  double squared_reach;    // of t = sqrt(sigma) (y - x); beyond it a term is exactly 0
  const double* position;  // [dimension][stride]
  const double* weights;   // [columns][stride]
  std::size_t stride;
  std::size_t columns;
  std::size_t combinations;
  const std::size_t* first_term;  // [combinations + 1]
  const int* order;               // [terms][max_dimension]: alpha
  const double* coefficient;      // [terms]
  const int* highest;             // [dimension]
  Recurrence recurrence;
  std::size_t groups;
  const CellsGroup* group;  // in ascending order
  const std::size_t* run;   // [runs][2]: first source and the one after the last
  const double* target;     // [dimension][target_stride]
  double* out;              // [combinations columns][target_stride], overwritten
  std::size_t target_stride;
};

/// Sources of one group of `outer_product`, and grid nodes an axis of one block of its window.
constexpr std::size_t outer_product_depth = 32;
constexpr std::size_t outer_product_nodes = 256;

/// One group of sources on one block of grid nodes:
///   out[q c + k][nodes] += sum_p weights[k][p] sum_{parts of q} factor prod_l h~_{alpha_l}(sqrt(sigma) (node_l - x_p)_l)
/// Parts of a combination that share alpha_0 are a bundle: a bundle is one product of matrices.
struct OuterProductJob {
  int dimension;
  int degree;
  double root_sigma;
  double reach;  // distance beyond which nothing counts
  std::size_t sources;
  const double* position;  // [dimension][stride]
  const double* weights;   // [columns][stride]
  std::size_t stride;
  std::size_t columns;
  const double* low;                  // [dimension]: bounding box of the group
  const double* high;                 // [dimension]
  const double* node[max_dimension];  // first node of the block
  std::size_t nodes[max_dimension];   // of the block, 1 beyond `dimension`
  std::size_t step[max_dimension];    // from a node to the next in `out`
  const int* highest;                 // [max_dimension]
  std::size_t combinations;
  const std::size_t* first_bundle;  // [combinations + 1]
  const int* bundle_order;          // [bundles]: alpha_0
  const std::size_t* first_part;    // [bundles + 1]
  const int* order;                 // [parts][max_dimension]: alpha
  const double* factor;             // [parts]
  Recurrence recurrence;
  double* scratch;            // outer_product_scratch(...) numbers
  double* out;                // of the block's first node
  std::size_t output_stride;  // from one output to the next
};

/// Size of OuterProductJob::scratch for blocks of up to nodes[l] nodes an axis: the tables of all axes, then the rows of the
/// second axis with weights.
constexpr std::size_t outer_product_scratch(int dimension, const int* highest, const std::size_t* nodes) {
  std::size_t size = outer_product_depth * (1 + (dimension > 1 ? nodes[1] : 1));
  for (int l = 0; l < dimension; ++l) {
    const std::size_t row = l == 0 ? nodes[0] + row_padding : nodes[l];
    size += row + outer_product_depth * (1 + row * (static_cast<std::size_t>(highest[l]) + 1));
  }
  return size;
}

}  // namespace fgtd::detail
