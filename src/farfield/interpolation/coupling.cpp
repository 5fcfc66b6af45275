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

}  // namespace

template <int d>
Coupling make_coupling(const Interpolation<d>& interpolation, const int* k) {
  constexpr std::size_t reflections = Interpolation<d>::reflections;
  const std::size_t octant = interpolation.octant(), nodes = interpolation.nodes();

  // values[s' of the source][j][s of the target][i]
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

  unsigned coupled = 0;  // parities in these axes mix
  for (unsigned l = 0; l < d; ++l)
    if (k[l] != 0) coupled |= 1U << l;
  Coupling coupling;
  coupling.degree = interpolation.degree();
  constexpr double mean = 1.0 / static_cast<double>(reflections * reflections);
  Buffer<double> half;
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
    for (std::size_t to = 0; to < parities.size(); ++to) {
      const std::size_t columns = interpolation.functions_of(parities[to]).size();
      if (columns == 0) continue;
      for (std::size_t from = 0; from < parities.size(); ++from) {
        const std::size_t rows = interpolation.functions_of(parities[from]).size();
        if (rows == 0) continue;
        // half[a... of the target][j] is needed transposed: first by j, then the sum over j
        half.assign(octant * columns + padding, 0.0);
        fastest_kernels().product({.rows = octant,
                                   .depth = octant,
                                   .width = columns,
                                   .a = values.data() + parities[from] * octant * nodes + parities[to] * octant,
                                   .a_stride = nodes,
                                   .b = interpolation.weights_of(parities[to]).data(),
                                   .b_stride = columns,
                                   .c = half.data(),
                                   .c_stride = columns});
        const std::vector<double>& weight = interpolation.weights_of(parities[from]);
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
                                   .c = block.matrix.data() + first[from] * size + first[to],
                                   .c_stride = size});
      }
    }
    coupling.blocks.push_back(std::move(block));
  }
  return coupling;
}

template Coupling make_coupling<2>(const Interpolation<2>&, const int*);
template Coupling make_coupling<3>(const Interpolation<3>&, const int*);

}  // namespace farfield::detail
