// The kernels of `direct` and `hermite`; one kernels_*.cpp an instruction set includes this (see kernels_vector.hpp).
#include "fgtd/cells_kernels.hpp"
#include "fgtd/chebyshev_jobs.hpp"
#include "fgtd/kernels.hpp"
#include "fgtd/kernels_vector.hpp"
#include "fgtd/outer_kernels.hpp"
#include "fgtd/product_kernels.hpp"

namespace fgtd::detail::FGTD_ISA {
namespace {

constexpr std::size_t source_chunk = 256;  // partial sums of so many terms, then added: rounding grows with N/256 + 256
constexpr std::size_t max_outputs = 16;    // sums kept at a time by `direct`

// ---------------------------------------------------------------------------------------------------------------
// direct

/// The plain Gaussian, `columns` columns of weights at a time and two vectors of targets:
///   out[k][i] = sum_j weights[k][j] exp(-sigma |y_i - x_j|^2)
template <int d, int columns>
void direct_values(const DirectJob& job, const double* weights, double* out) {
  constexpr std::size_t vectors = 2 * lanes <= group_size ? 2 : 1;
  for (std::size_t first = 0; first < group_size; first += vectors * lanes) {
    Vector y[d][vectors];
    for (int l = 0; l < d; ++l)
      for (std::size_t v = 0; v < vectors; ++v)
        y[l][v] = load(job.target + static_cast<std::size_t>(l) * group_size + first + v * lanes);
    Vector total[columns][vectors] = {};
    for (std::size_t begin = 0; begin < job.sources; begin += source_chunk) {
      const std::size_t end = begin + source_chunk < job.sources ? begin + source_chunk : job.sources;
      Vector partial[columns][vectors] = {};
      for (std::size_t j = begin; j < end; ++j) {
        for (std::size_t v = 0; v < vectors; ++v) {
          Vector squared{};
          for (int l = 0; l < d; ++l) {
            const Vector distance = y[l][v] - job.position[static_cast<std::size_t>(l) * job.sources + j];
            squared += distance * distance;
          }
          const Vector gaussian = exp_nonpositive(squared * -job.sigma);
          for (int k = 0; k < columns; ++k)
            partial[k][v] += gaussian * weights[static_cast<std::size_t>(k) * job.sources + j];
        }
      }
      for (int k = 0; k < columns; ++k)
        for (std::size_t v = 0; v < vectors; ++v) total[k][v] += partial[k][v];
    }
    for (int k = 0; k < columns; ++k)
      for (std::size_t v = 0; v < vectors; ++v)
        store(out + static_cast<std::size_t>(k) * group_size + first + v * lanes, total[k][v]);
  }
}

template <int d>
void direct_all_values(const DirectJob& job) {
  const double scale = job.coefficient[0];
  for (std::size_t k = 0; k < job.columns; k += 4) {
    const double* weights = job.weights + k * job.sources;
    double* out = job.out + k * group_size;
    switch (job.columns - k) {
      case 1:
        direct_values<d, 1>(job, weights, out);
        break;
      case 2:
        direct_values<d, 2>(job, weights, out);
        break;
      case 3:
        direct_values<d, 3>(job, weights, out);
        break;
      default:
        direct_values<d, 4>(job, weights, out);
    }
  }
  for (std::size_t i = 0; i < job.columns * group_size; ++i) job.out[i] *= scale;
}

/// Derivatives: combinations [q0, q1) for columns [k0, k1). Every |t_l| is clamped to 27: beyond it the Gaussian is
/// exactly 0 and the polynomials stay finite.
template <int d>
void direct_terms(const DirectJob& job, std::size_t q0, std::size_t q1, std::size_t k0, std::size_t k1) {
  for (std::size_t first = 0; first < group_size; first += lanes) {
    Vector total[max_outputs] = {};
    for (std::size_t begin = 0; begin < job.sources; begin += source_chunk) {
      const std::size_t end = begin + source_chunk < job.sources ? begin + source_chunk : job.sources;
      Vector partial[max_outputs] = {};
      for (std::size_t j = begin; j < end; ++j) {
        Vector polynomial[d][max_derivative_order + 1];  // H_n(t_l) / sqrt(2^n n!)
        Vector squared{};
        for (int l = 0; l < d; ++l) {
          const std::size_t axis = static_cast<std::size_t>(l);
          const Vector t = clamp(
              (load(job.target + axis * group_size + first) - job.position[axis * job.sources + j]) * job.root_sigma,
              27.0);
          squared += t * t;
          Vector previous{}, current = broadcast(1.0);
          for (int n = 0; n < job.highest[l]; ++n) {
            const Vector next = t * current * job.recurrence.up[n] - previous * job.recurrence.back[n];
            previous = current;
            current = next;
            polynomial[l][n + 1] = next;
          }
        }
        const Vector gaussian = exp_nonpositive(-squared);
        std::size_t output = 0;
        for (std::size_t q = q0; q < q1; ++q) {
          Vector sum{};
          for (std::size_t term = job.first_term[q]; term < job.first_term[q + 1]; ++term) {
            Vector value = gaussian;
            for (int l = 0; l < d; ++l) {
              const int order = job.order[term * max_dimension + static_cast<std::size_t>(l)];
              if (order > 0) value *= polynomial[l][order];
            }
            sum += value * job.coefficient[term];
          }
          for (std::size_t k = k0; k < k1; ++k) partial[output++] += sum * job.weights[k * job.sources + j];
        }
      }
      for (std::size_t output = 0; output < (q1 - q0) * (k1 - k0); ++output) total[output] += partial[output];
    }
    std::size_t output = 0;
    for (std::size_t q = q0; q < q1; ++q)
      for (std::size_t k = k0; k < k1; ++k)
        store(job.out + (q * job.columns + k) * group_size + first, total[output++]);
  }
}

template <int d>
void direct_in(const DirectJob& job) {
  bool plain = job.combinations == 1 && job.first_term[1] == 1;
  for (int l = 0; l < d; ++l) plain = plain && job.highest[l] == 0;
  if (plain) {
    direct_all_values<d>(job);
    return;
  }
  const std::size_t block = job.combinations < max_outputs ? job.combinations : max_outputs;
  const std::size_t column_block = max_outputs / (block > 0 ? block : 1);
  for (std::size_t q = 0; q < job.combinations; q += block)
    for (std::size_t k = 0; k < job.columns; k += column_block)
      direct_terms<d>(job, q, q + block < job.combinations ? q + block : job.combinations, k,
                      k + column_block < job.columns ? k + column_block : job.columns);
}

void direct(const DirectJob& job) {
  switch (job.dimension) {
    case 1:
      return direct_in<1>(job);
    case 2:
      return direct_in<2>(job);
    case 3:
      return direct_in<3>(job);
    default:
      return direct_in<4>(job);
  }
}

// ---------------------------------------------------------------------------------------------------------------
// product

void product(const ProductJob& job) {
  multiply_add(job.rows, job.depth, job.width, job.b, job.b_stride, job.d, job.d_stride, job.c, job.c_stride);
}

// ---------------------------------------------------------------------------------------------------------------
// expansion

/// sums[i] = sum_b moments[i terms + b] g[b] for `rows` rows; g[b] is `vectors` vectors. Rows side by side keep the
/// multipliers busy, which a single sum would leave waiting for its last addition.
template <int rows, int vectors>
FGTD_INLINE void contract_rows(std::size_t terms, const double* moments, const double* g,
                               Vector (&sums)[rows][vectors]) {
  for (int i = 0; i < rows; ++i)
    for (int v = 0; v < vectors; ++v) sums[i][v] = Vector{};
  for (std::size_t b = 0; b < terms; ++b) {
    Vector factor[vectors];
    for (int v = 0; v < vectors; ++v) factor[v] = load(g + (b * vectors + static_cast<std::size_t>(v)) * lanes);
    for (int i = 0; i < rows; ++i) {
      const double moment = moments[static_cast<std::size_t>(i) * terms + b];
      for (int v = 0; v < vectors; ++v) sums[i][v] += factor[v] * moment;
    }
  }
}

/// Rows b .. b+rows of the second axis, added to `sum`.
template <int rows, int vectors>
FGTD_INLINE void contract_plane_rows(std::size_t terms, std::size_t b, const double* moments, const double* const* g,
                                     Vector (&sum)[vectors]) {
  Vector inner[rows][vectors];
  contract_rows<rows, vectors>(terms, moments + b * terms, g[0], inner);
  for (int i = 0; i < rows; ++i)
    for (int v = 0; v < vectors; ++v)
      sum[v] += inner[i][v] *
                load(g[1] + ((b + static_cast<std::size_t>(i)) * vectors + static_cast<std::size_t>(v)) * lanes);
}

/// sum_beta moments[beta] prod_{l <= axis} g_l[beta_l], first axis fastest; advances `moments` past what was read.
template <int axis, int vectors>
FGTD_INLINE void contract(std::size_t terms, const double*& moments, const double* const* g, Vector (&sum)[vectors]) {
  if constexpr (axis == 0) {
    Vector row[1][vectors];
    contract_rows<1, vectors>(terms, moments, g[0], row);
    for (int v = 0; v < vectors; ++v) sum[v] = row[0][v];
    moments += terms;
  } else if constexpr (axis == 1) {
    for (int v = 0; v < vectors; ++v) sum[v] = Vector{};
    std::size_t b = 0;
    for (; b + 4 <= terms; b += 4) contract_plane_rows<4, vectors>(terms, b, moments, g, sum);
    if (b + 2 <= terms) {
      contract_plane_rows<2, vectors>(terms, b, moments, g, sum);
      b += 2;
    }
    if (b < terms) contract_plane_rows<1, vectors>(terms, b, moments, g, sum);
    moments += terms * terms;
  } else {
    for (int v = 0; v < vectors; ++v) sum[v] = Vector{};
    for (std::size_t b = 0; b < terms; ++b) {
      Vector inner[vectors];
      contract<axis - 1, vectors>(terms, moments, g, inner);
      for (int v = 0; v < vectors; ++v)
        sum[v] += inner[v] * load(g[axis] + (b * vectors + static_cast<std::size_t>(v)) * lanes);
    }
  }
}

template <int d, int vectors>
void expansion_at(const ExpansionJob& job, std::size_t first) {
  constexpr std::size_t width = vectors * lanes;
  const std::size_t p = static_cast<std::size_t>(job.terms);
  std::size_t moments_size = 1;
  for (int l = 0; l < d; ++l) moments_size *= p;

  // scratch: h~_n of every axis, then g_{a,b} for every axis and a >= 1
  double* hermite[d];
  double* derived[d];
  double* free = job.scratch;
  for (int l = 0; l < d; ++l) {
    hermite[l] = free;
    free += (p + static_cast<std::size_t>(job.highest[l])) * width;
    derived[l] = free;
    free += p * static_cast<std::size_t>(job.highest[l]) * width;
  }

  for (std::size_t near = 0; near < job.boxes; ++near) {
    const std::size_t box = job.box[near];
    Vector t[d][vectors];
    Vector gap[vectors] = {};  // squared distance to the box
    for (int l = 0; l < d; ++l)
      for (int v = 0; v < vectors; ++v) {
        const std::size_t lane = first + static_cast<std::size_t>(v) * lanes;
        const double centre = job.centre[box * d + static_cast<std::size_t>(l)];
        t[l][v] = (load(job.target + static_cast<std::size_t>(l) * group_size + lane) - centre) * job.root_sigma;
        const Vector beyond = (t[l][v] < 0.0 ? -t[l][v] : t[l][v]) - job.half_side;
        gap[v] += select(reinterpret_cast<Bits>(beyond > 0.0), beyond * beyond);
        t[l][v] = clamp(t[l][v], 1e3);  // h~_0 is 0 there, and the recurrence keeps it
      }
    Bits any{};
    for (int v = 0; v < vectors; ++v) any |= reinterpret_cast<Bits>(gap[v] <= job.squared_reach);
    unsigned long long some = 0;
    for (std::size_t i = 0; i < lanes; ++i) some |= any[i];
    if (some == 0) continue;

    for (int l = 0; l < d; ++l)
      for (int v = 0; v < vectors; ++v) {
        Vector previous{};
        Vector current = exp_nonpositive(-(t[l][v] * t[l][v]));
        if (l == 0) current = select(reinterpret_cast<Bits>(gap[v] <= job.squared_reach), current);
        double* row = hermite[l] + static_cast<std::size_t>(v) * lanes;
        const int highest = job.terms - 1 + job.highest[l];
        store(row, current);
        for (int n = 0; n < highest; ++n) {
          const Vector next = t[l][v] * job.recurrence.up[n] * current - previous * job.recurrence.back[n];
          previous = current;
          current = next;
          row += width;
          store(row, current);
        }
        for (int a = 1; a <= job.highest[l]; ++a) {
          const double* from = hermite[l] + static_cast<std::size_t>(a) * width + static_cast<std::size_t>(v) * lanes;
          double* to = derived[l] + static_cast<std::size_t>(a - 1) * p * width + static_cast<std::size_t>(v) * lanes;
          for (std::size_t b = 0; b < p; ++b)
            store(to + b * width, load(from + b * width) * job.binomial_root[static_cast<std::size_t>(a) * p + b]);
        }
      }

    for (std::size_t derivative = 0; derivative < job.derivatives; ++derivative) {
      const double* g[d];
      for (int l = 0; l < d; ++l) {
        const int a = job.order[derivative * max_dimension + static_cast<std::size_t>(l)];
        g[l] = a == 0 ? hermite[l] : derived[l] + static_cast<std::size_t>(a - 1) * p * width;
      }
      for (std::size_t k = 0; k < job.columns; ++k) {
        const double* moments = job.moments + (box * job.columns + k) * moments_size;
        Vector sum[vectors];
        contract<d - 1, vectors>(p, moments, g, sum);
        double* out = job.out + (derivative * job.columns + k) * group_size + first;
        for (int v = 0; v < vectors; ++v)
          store(out + static_cast<std::size_t>(v) * lanes, load(out + static_cast<std::size_t>(v) * lanes) + sum[v]);
      }
    }
  }
}

template <int d>
void expansion_in(const ExpansionJob& job) {
  for (std::size_t first = 0; first < job.targets; first += 2 * lanes) {
    if (job.targets - first <= lanes) {
      expansion_at<d, 1>(job, first);
    } else {
      expansion_at<d, 2>(job, first);
    }
  }
}

void expansion(const ExpansionJob& job) {
  switch (job.dimension) {
    case 1:
      return expansion_in<1>(job);
    case 2:
      return expansion_in<2>(job);
    case 3:
      return expansion_in<3>(job);
    default:
      return expansion_in<4>(job);
  }
}

// ---------------------------------------------------------------------------------------------------------------
// table

void table(const TableJob& job) {
  for (std::size_t i = 0; i < job.count; i += lanes) {
    const Vector t = clamp(load(job.t + i), 1e3);
    Vector previous{};
    Vector current = exp_nonpositive(-(t * t));
    store(job.rows + i, current);
    for (int n = 0; n + 1 < job.orders; ++n) {
      const Vector next = t * job.recurrence.up[n] * current - previous * job.recurrence.back[n];
      previous = current;
      current = next;
      store(job.rows + static_cast<std::size_t>(n + 1) * job.stride + i, current);
    }
  }
}

#include "fgtd/spread_kernels.hpp"

#include "fgtd/chebyshev_kernels.hpp"

}  // namespace

#define FGTD_TEXT_OF(x) #x
#define FGTD_TEXT(x) FGTD_TEXT_OF(x)
extern const Kernels kernels;
const Kernels kernels = {FGTD_TEXT(FGTD_ISA), direct, product, expansion, table, spread, cells, outer,
                         chebyshev::locate, chebyshev::moments, chebyshev::interpolate, chebyshev::chain};

}  // namespace fgtd::detail::FGTD_ISA
