// The inner loops. They are plain loops over raw pointers, compiled once for every instruction set (*kernels.cpp) and
// picked at run time. So one program runs on every processor and uses the fastest instructions that it has.
#pragma once

#include <cstddef>

namespace farfield::detail {

/// Arrays of coordinates and charges are readable this many numbers past their end.
constexpr std::size_t padding = 16;

/// Distances are taken in units in which the points extend over about 1, so that no square leaves the range of float
/// at the upper end.
enum class Interaction {
  inverse,    // 3D: 1/r and d/r^3
  logarithm,  // 2D: ln r and d/r^2
  blob        // 2D: (1 - exp(-r^2/eps^2)) d/r^2
};

/// The relative accuracy of 1/r.
enum class Precision { full, ten_digits, six_digits };

struct Range {
  std::size_t begin, end;
};

/// out_i += sum_j q_j k(x_i - y_j) for the targets of a range and the sources of several; d = x_i - y_j.
struct PairsJob {
  Interaction interaction;
  Precision precision;      // of inverse only
  const double* target[3];  // [dimension]: arrays of coordinates
  Range targets;
  const double* source[3];
  const double* charge;  // |q| <= 2^30 for six_digits
  const Range* runs;
  std::size_t run_count;
  bool same_points;             // source i is target i; six_digits does not take their pair for a close one
  double log_shift;             // added to every ln r
  double inverse_squared_core;  // 1/eps^2, of blob
  double point_beyond;          // r^2/eps^2 from which a blob is taken for a point: exp(-r^2/eps^2) is negligible
  // six_digits: coordinates are taken relative to `centre` in whole multiples of `quantum`, less than 2^30 of them
  double centre[3];
  double quantum;
  double closest;     // pairs nearer than that are computed in double; six_digits
  double* potential;  // by target like the coordinates; null: not wanted
  double* field[3];   // null: not wanted
};

/// The kernels of general.hpp; only those with a name are summed here.
enum class GeneralShape { yukawa, inverse_power, gaussian, of_distance, of_difference };

/// out_i += sum_j q_j k(x_i - y_j) for the targets of a range and the sources of several. Pairs at distance 0 are left out
/// where k is infinite there.
struct GeneralPairsJob {
  GeneralShape shape;
  int dimension;
  double parameter;         // lambda, power or sigma
  const double* target[3];  // [dimension]: arrays of coordinates
  Range targets;
  const double* source[3];
  const double* charge;
  const Range* runs;
  std::size_t run_count;
  double* out;  // by target like the coordinates
};

/// C (rows x width) += A (rows x depth) B (depth x width), all row-major; B is readable `padding` numbers past its end.
struct ProductJob {
  std::size_t rows, depth, width;
  const double* a;
  std::size_t a_stride;
  const double* b;
  std::size_t b_stride;
  double* c;
  std::size_t c_stride;
};

/// moments[k] = sum_j q_j h_k(scale (y_j - centre)) for the functions of harmonics.hpp.
struct MomentsJob {
  int dimension;
  int degree;
  const double* up;    // 3D: [l (degree + 1) + m]: (2l - 1) l / (l^2 - m^2)
  const double* back;  // 3D: l (l - 1) / (l^2 - m^2)
  const double* point[3];
  const double* charge;
  Range range;
  double centre[3];
  double scale;
  double* moments;  // overwritten
  double* scratch;  // functions x lanes
};
constexpr std::size_t max_lanes = 8;

/// At scale (x_i - centre):
///   potential_i += sum_k coefficient[0][k] h_k,   field_i[l] += field_scale sum_k coefficient[1 + l][k] h_k
struct ExpansionJob {
  int dimension;
  int degree;
  const double* up;
  const double* back;
  const double* point[3];
  Range range;
  double centre[3];
  double scale;
  const double* coefficient[4];
  double field_scale;
  double* potential;  // null: not wanted
  double* field[3];
};

/// values[i] = 1/sqrt(values[i]) for 1e-37 < values[i] < 1e37, to full precision.
struct InverseRootsJob {
  double* values;
  std::size_t count;
};

struct Kernels {
  const char* name;
  std::size_t lanes;  // doubles in a vector
  void (*pairs)(const PairsJob&);
  void (*product)(const ProductJob&);
  void (*moments)(const MomentsJob&);
  void (*expansion)(const ExpansionJob&);
  void (*inverse_roots)(const InverseRootsJob&);
  void (*general_pairs)(const GeneralPairsJob&);
};

/// Those of the fastest instruction set that this processor runs.
const Kernels& fastest_kernels();

}  // namespace farfield::detail
