#include "farfield/interpolation/operators.hpp"

#include <algorithm>
#include <cstdlib>
#include <mutex>

#include "base/parallel.hpp"
#include "farfield/cost.hpp"
#include "farfield/interpolation/measured_error.hpp"
#include "farfield/kernels/kernels.hpp"

namespace farfield::detail {
namespace {

template <int d>
constexpr double measured[1][1] = {{0}};
#include "farfield/interpolation/error_table.inc"

/// The table is the largest error that a search found; other searches found up to 1.02 times as much.
constexpr double safety = 1.1;

/// Smallest degree whose error at offset class c is at most the tolerance; 0 if there is none.
template <int d>
int degree_for(std::size_t c, double tolerance) {
  for (int n = 1; n <= table_degrees<d>; ++n)
    if (safety * measured<d>[c][n - 1] <= tolerance) return n;
  return 0;
}

/// The offset with k_l >= 0 of that number.
template <int d>
std::array<int, 3> offset(std::size_t number) {
  std::array<int, 3> k{};
  for (int l = 0; l < d; ++l) {
    k[static_cast<std::size_t>(l)] = static_cast<int>(number % (farthest + 1));
    number /= farthest + 1;
  }
  return k;
}

template <int d>
constexpr std::size_t rows = sizeof(measured<d>) / sizeof(measured<d>[0]);

}  // namespace

template <int d>
double Degrees<d>::smallest_error() {
  double smallest = 0;
  for (std::size_t c = 0; c < rows<d>; ++c)
    smallest = std::max(smallest, safety * *std::min_element(measured<d>[c], measured<d>[c] + table_degrees<d>));
  return smallest;
}

template <int d>
Degrees<d>::Degrees(double tolerable, double tolerable_one_sided) {
  const auto classes = offset_classes<d>();
  const auto degree_of_class = [&](std::size_t c) {
    const bool alone = c == classes.size();
    const int n = degree_for<d>(c, alone ? tolerable_one_sided : tolerable);
    highest = std::max(highest, n);
    double& largest = alone ? one_sided_error : error;
    largest = std::max(largest, safety * measured<d>[c][n - 1]);
    return n;
  };
  one_sided = degree_of_class(classes.size());
  for (std::size_t number = 0; number < octant_offsets<d>; ++number) {
    std::array<int, 3> k = offset<d>(number);
    std::sort(k.begin(), k.end(), std::greater<>());
    const auto found = std::find(classes.begin(), classes.end(), k);
    if (found != classes.end()) at_offset[number] = degree_of_class(static_cast<std::size_t>(found - classes.begin()));
  }
}

template <int d>
Operators<d>::Operators(const Degrees<d>& degrees, bool couplings, int threads) : degrees_(degrees) {
  std::vector<std::unique_ptr<Interpolation<d>>> interpolation(static_cast<std::size_t>(degrees.highest) + 1);
  const auto needed = [&](int n) {
    const int* const end = degrees.at_offset + octant_offsets<d>;
    return n == degrees.highest || n == degrees.one_sided || (couplings && std::find(degrees.at_offset, end, n) != end);
  };
  const auto size_of = [](int degree) {
    return std::pair{static_cast<double>(detail::functions<d>(degree)),
                     static_cast<double>(nodes_of_degree<d>(degree))};
  };
  double fits = 0, tables = 0;
  for (std::size_t n = 1; n < interpolation.size(); ++n)
    if (needed(static_cast<int>(n))) {
      const auto [functions, nodes] = size_of(static_cast<int>(n));
      fits += fitted_number * functions * functions * nodes;
    }
  gaussdrift::base::parallel_for({interpolation.size(), fits}, threads, [&](std::size_t n) {
    if (n > 0 && needed(static_cast<int>(n)))
      interpolation[n] = std::make_unique<Interpolation<d>>(static_cast<int>(n));
  });

  place_.resize(functions());
  std::size_t next = 0;
  for (unsigned p = 0; p < octants; ++p) {
    first_of_[p] = next;
    for (std::size_t k = 0; k < functions(); ++k)
      if (parity<d>(k) == p) place_[k] = next++;
  }

  if (couplings) coupling_.resize(octant_offsets<d>);
  for (std::size_t number = 0; couplings && number < octant_offsets<d>; ++number)
    if (const int degree = degrees.at_offset[number]; degree > 0)
      tables += table_entry * size_of(degree).second * size_of(degree).second;
  const auto [functions, nodes] = size_of(degrees.highest);
  tables += fitted_number * functions * functions * nodes;  // the transfer
  gaussdrift::base::parallel_for({octant_offsets<d> + 1, tables}, threads, [&](std::size_t task) {
    if (task == octant_offsets<d>) return make_transfer(*interpolation[static_cast<std::size_t>(degrees.highest)]);
    const auto& between = interpolation[static_cast<std::size_t>(degrees.at_offset[task])];
    if (couplings && between) coupling_[task] = make_coupling<d>(*between, offset<d>(task).data());
  });
  one_sided_ = std::make_unique<Interpolation<d>>(*interpolation[static_cast<std::size_t>(degrees.one_sided)]);

  if (d == 3) {
    const std::size_t stride = static_cast<std::size_t>(degree()) + 1;
    up_.resize(stride * stride);
    back_.resize(stride * stride);
    for (int l = 1; l <= degree(); ++l)
      for (int m = 0; m < l; ++m) {
        const std::size_t at = static_cast<std::size_t>(l) * stride + static_cast<std::size_t>(m);
        up_[at] = static_cast<double>((2 * l - 1) * l) / (l * l - m * m);
        back_[at] = static_cast<double>(l * (l - 1)) / (l * l - m * m);
      }
  }
}

// h_k of the parent is a harmonic polynomial in the child's coordinates too, so interpolation in the child is exact:
// t_parent = t_child / 2 +- stretch / 4. Octants are reflections of octant 0.
template <int d>
void Operators<d>::make_transfer(const Interpolation<d>& interpolation) {
  const std::size_t count = functions(), nodes = interpolation.nodes(), octant = interpolation.octant();
  std::vector<double> values(nodes * count), column(nodes), coefficients(count);
  for (std::size_t s = 0; s < octants; ++s)
    for (std::size_t i = 0; i < octant; ++i) {
      double t[d];
      for (std::size_t l = 0; l < d; ++l) t[l] = stretch * (interpolation.node(s, i, l) / 2 - 0.25);
      evaluate_harmonics<d>(degree(), t, values.data() + (s * octant + i) * count);
    }
  for (std::size_t o = 0; o < octants; ++o) {
    transfer_[o].assign(count * count + padding, 0.0);
    transposed_[o].assign(count * count + padding, 0.0);
  }
  std::vector<int> degrees(count);
  std::vector<unsigned> parities(count);
  for (std::size_t k = 0; k < count; ++k) {
    degrees[k] = degree_of<d>(k);
    parities[k] = parity<d>(k);
  }
  for (std::size_t k = 0; k < count; ++k) {
    for (std::size_t i = 0; i < nodes; ++i) column[i] = values[i * count + k];
    interpolation.fit(column.data(), coefficients.data());
    for (std::size_t m = 0; m < count && degrees[m] <= degrees[k]; ++m)
      for (std::size_t o = 0; o < octants; ++o) {
        const double value = coefficients[m] * sign(parities[m] ^ parities[k], o);
        transfer_[o][place(m) * count + place(k)] = value;
        transposed_[o][place(k) * count + place(m)] = value;
      }
  }
}

template <int d>
std::shared_ptr<const Operators<d>> Operators<d>::get(const Degrees<d>& degrees, bool couplings, int threads) {
  static std::mutex mutex;
  static std::weak_ptr<const Operators> last;
  const std::lock_guard lock(mutex);
  std::shared_ptr<const Operators> operators = last.lock();
  if (!operators || !(operators->degrees_ == degrees) || (couplings && operators->coupling_.empty())) {
    operators = std::make_shared<const Operators>(degrees, couplings, threads);
    last = operators;
  }
  return operators;
}

template struct Degrees<2>;
template struct Degrees<3>;
template class Operators<2>;
template class Operators<3>;

}  // namespace farfield::detail
