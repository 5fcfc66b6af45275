#include "farfield/interpolation/coupling.hpp"

#include <algorithm>
#include <cmath>

#include "farfield/kernels/kernels.hpp"

namespace farfield::detail {
namespace {

/// Replaces the values at reflections s = 0, 1, ... of a run by their sums with the signs of parity p = 0, 1, ...
template <int d>
void to_parities(double* values, std::size_t run) {
  for (std::size_t bit = 1; bit < (std::size_t{1} << d); bit *= 2)
    for (std::size_t s = 0; s < (std::size_t{1} << d); ++s) {
      if ((s & bit) != 0) continue;
      double* const even = values + s * run;
      double* const odd = values + (s | bit) * run;
      for (std::size_t i = 0; i < run; ++i) {
        const double sum = even[i] + odd[i];
        odd[i] = even[i] - odd[i];
        even[i] = sum;
      }
    }
}

/// The kernel between the nodes of two clusters whose cells are k apart, by parities in all axes:
/// values[s' of the source][j][s of the target][i].
template <int d>
Buffer<double> kernel_by_parities(const Interpolation<d>& interpolation, const int* k) {
  constexpr std::size_t reflections = Interpolation<d>::reflections;
  const std::size_t octant = interpolation.octant(), nodes = interpolation.nodes();
  Buffer<double> values(nodes * nodes), target(d * nodes);
  for (std::size_t l = 0; l < d; ++l)
    for (std::size_t s = 0; s < reflections; ++s)
      for (std::size_t i = 0; i < octant; ++i) target[l * nodes + s * octant + i] = k[l] + interpolation.node(s, i, l);
  for (std::size_t s = 0; s < reflections; ++s)
    for (std::size_t j = 0; j < octant; ++j) {
      double* const row = values.data() + (s * octant + j) * nodes;
      for (std::size_t i = 0; i < nodes; ++i) row[i] = 0;
      for (std::size_t l = 0; l < d; ++l) {
        const double y = interpolation.node(s, j, l);
        for (std::size_t i = 0; i < nodes; ++i) {
          const double distance = target[l * nodes + i] - y;
          row[i] += distance * distance;
        }
      }
      if (d == 3)
        fastest_kernels().inverse_roots({row, nodes});
      else
        for (std::size_t i = 0; i < nodes; ++i) row[i] = std::log(row[i]) / 2;
      to_parities<d>(row, octant);
    }
  to_parities<d>(values.data(), octant * nodes);
  return values;
}

/// The part of a block's matrix between the functions of two parities; `to` points at its first entry, `size` numbers
/// from row to row.
template <int d>
void couple(const Interpolation<d>& interpolation, const Buffer<double>& values, unsigned from_parity,
            unsigned to_parity, double* to, std::size_t size) {
  constexpr double mean = 1.0 / static_cast<double>(Interpolation<d>::reflections * Interpolation<d>::reflections);
  const std::size_t octant = interpolation.octant(), nodes = interpolation.nodes();
  const std::size_t columns = interpolation.functions_of(to_parity).size();
  const std::size_t rows = interpolation.functions_of(from_parity).size();
  if (rows == 0 || columns == 0) return;
  // half[a... of the target][j] is needed transposed: first by j, then the sum over j
  Buffer<double> half;
  half.assign(octant * columns + padding, 0.0);
  fastest_kernels().product({.rows = octant,
                             .depth = octant,
                             .width = columns,
                             .a = values.data() + from_parity * octant * nodes + to_parity * octant,
                             .a_stride = nodes,
                             .b = interpolation.weights_of(to_parity).data(),
                             .b_stride = columns,
                             .c = half.data(),
                             .c_stride = columns});
  const std::vector<double>& weight = interpolation.weights_of(from_parity);
  Buffer<double> transposed(rows * octant);
  for (std::size_t j = 0; j < octant; ++j)
    for (std::size_t b = 0; b < rows; ++b) transposed[b * octant + j] = weight[j * rows + b] * mean;
  fastest_kernels().product({.rows = rows,
                             .depth = octant,
                             .width = columns,
                             .a = transposed.data(),
                             .a_stride = octant,
                             .b = half.data(),
                             .b_stride = columns,
                             .c = to,
                             .c_stride = size});
}

}  // namespace

template <int d>
Coupling make_coupling(const Interpolation<d>& interpolation, const int* k) {
  constexpr std::size_t reflections = Interpolation<d>::reflections;
  const Buffer<double> values = kernel_by_parities<d>(interpolation, k);

  unsigned coupled = 0;  // parities in these axes mix
  for (unsigned l = 0; l < d; ++l)
    if (k[l] != 0) coupled |= 1U << l;
  Coupling coupling;
  coupling.degree = interpolation.degree();
  for (unsigned base = 0; base < reflections; ++base) {
    if ((base & coupled) != 0) continue;
    Coupling::Block block;
    std::vector<unsigned> parities;
    std::vector<std::size_t> first;
    for (unsigned p = 0; p < reflections; ++p) {
      if ((p & ~coupled) != base) continue;
      parities.push_back(p);
      first.push_back(block.functions.size());
      const auto& set = interpolation.functions_of(p);
      block.functions.insert(block.functions.end(), set.begin(), set.end());
      block.runs.push_back({p, set.size()});
    }
    const std::size_t size = block.functions.size();
    if (size == 0) continue;
    block.matrix.assign(size * size + padding, 0.0);
    for (std::size_t to = 0; to < parities.size(); ++to)
      for (std::size_t from = 0; from < parities.size(); ++from)
        couple<d>(interpolation, values, parities[from], parities[to],
                  block.matrix.data() + first[from] * size + first[to], size);
    coupling.blocks.push_back(std::move(block));
  }
  return coupling;
}

template Coupling make_coupling<2>(const Interpolation<2>&, const int*);
template Coupling make_coupling<3>(const Interpolation<3>&, const int*);

}  // namespace farfield::detail
