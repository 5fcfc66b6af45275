#include "farfield/tree/clustered.hpp"

#include <algorithm>
#include <cmath>

#include "base/parallel.hpp"
#include "farfield/catalogue.hpp"
#include "farfield/cost.hpp"

namespace farfield::detail {

template <int d>
Clustered<d>::Clustered(const Problem& problem, Parts parts)
    : problem_(problem),
      tree_(std::move(parts.tree)),
      partition_(std::move(parts.partition)),
      operators_(std::move(parts.operators)),
      near_(problem_, tree_, parts.precisions),
      threads_(parts.threads),
      work_(parts.work),
      exchange_(std::move(parts.exchange)),
      exchange_bytes_(parts.exchange_bytes) {}

template <int d>
double Clustered<d>::evaluation_bytes() const {
  const double outputs = d + 1;
  return 8.0 * static_cast<double>(tree_.sources().position[0].size()) +
         8.0 * outputs * static_cast<double>(tree_.targets().position[0].size()) +
         bytes_per_cluster() * static_cast<double>(tree_.clusters().size()) + exchange_bytes_;
}

template <int d>
void Clustered<d>::evaluate(const Buffer<double>& charges, Sums& sums, Seconds& seconds) const {
  Laps laps;
  const auto& sources = tree_.sources().original;
  const auto& targets = tree_.targets().original;
  const std::size_t begin = tree_.own_begin(), count = tree_.targets().position[0].size();
  Buffer<double> sorted;
  sorted.assign(tree_.sources().position[0].size(), 0.0);
  for (std::size_t j = 0; j < sources.size(); ++j) sorted[begin + j] = charges[sources[j]];
  Sums found;
  if (problem_.potential) found.potential.assign(count, 0.0);
  for (std::size_t l = 0; l < d; ++l) found.field[l].assign(count, 0.0);

  if (operators_) {
    PerCluster moments = forward<d>(tree_, *operators_, sorted, threads_);
    if (exchange_) {
      exchange_(sorted, moments, operators_->functions());
      forward_shared<d>(tree_, *operators_, threads_, moments);
    }
    seconds.forward = laps.lap();
    add_all(sorted, moments, found, seconds);
  } else {
    add_at_leaves(sorted, {}, found);
    seconds.leaves = laps.lap();
  }

  for (std::size_t i = 0; i < targets.size(); ++i) {
    if (problem_.potential) sums.potential[targets[i]] = found.potential[begin + i];
    for (std::size_t l = 0; l < d; ++l) sums.field[l][targets[i]] = found.field[l][begin + i];
  }
}

template <int d>
void Clustered<d>::add_at_leaves(const Buffer<double>& charges, const PerCluster& moments, Sums& sums) const {
  constexpr std::size_t piece = 16;  // clusters
  const std::size_t count = tree_.clusters().size();
  const double seconds = (work_.pairs + work_.substitute_pairs) * pair_seconds(problem_, Precision::full);
  gaussdrift::base::parallel_for(
      {(count + piece - 1) / piece, seconds}, threads_, [] { return typename NearField<d>::Substitutes{}; },
      [&](typename NearField<d>::Substitutes& substitutes, std::size_t p) {
        for (std::size_t i = p * piece; i < std::min(count, (p + 1) * piece); ++i) {
          const Cluster& leaf = tree_.clusters()[i];
          near_.add(leaf, partition_.runs.first(i), partition_.runs.count(i), charges, sums);
          const Index* const clusters = partition_.from_clusters.first(i);
          for (std::size_t n = 0; n < partition_.from_clusters.count(i); ++n) {
            substitutes.moments.resize(operators_->functions());
            operators_->in_order(moments.data() + clusters[n] * operators_->functions(), substitutes.moments.data());
            near_.add(leaf, operators_->one_sided(), tree_.clusters()[clusters[n]], substitutes, sums);
          }
          near_.act(leaf, substitutes, sums);
        }
      });
}

template <int d>
void TreeMethod<d>::add_all(const Buffer<double>& charges, const PerCluster& moments, Sums& sums,
                            Seconds& seconds) const {
  Laps laps;
  this->add_at_leaves(charges, moments, sums);
  seconds.leaves = laps.lap();
}

template <int d>
double SymmetricMethod<d>::evaluation_bytes() const {
  return Clustered<d>::evaluation_bytes() +
         this->bytes_per_cluster() * static_cast<double>(this->tree_.clusters().size());
}

template <int d>
void SymmetricMethod<d>::add_all(const Buffer<double>& charges, const PerCluster& moments, Sums& sums,
                                 Seconds& seconds) const {
  Laps laps;
  PerCluster coefficients(this->tree_.clusters().size() * this->operators_->functions());
  std::fill(coefficients.begin(), coefficients.end(), 0.0);
  // Of all pairs of functions those whose parities go together.
  const auto functions = static_cast<double>(this->operators_->functions());
  const double a_coupling = functions * (functions * 0.02e-9 + 2e-9);
  gaussdrift::base::parallel_for({this->partition_.couplings.size(), this->work_.couplings * a_coupling},
                                 this->threads_,
                                 [&](std::size_t c) { couple(this->partition_.couplings[c], moments, coefficients); });
  add_from_points(charges, coefficients);
  seconds.coupling = laps.lap();
  backward<d>(this->tree_, *this->operators_, coefficients, d == 3 ? -1 : 1, this->problem_.potential, this->threads_,
              sums);
  seconds.backward = laps.lap();
  this->add_at_leaves(charges, moments, sums);
  seconds.leaves = laps.lap();
}

// In units of the clusters' side h: 1/(h r) = 1/h 1/r and ln(h r) = ln h + ln r.
template <int d>
void SymmetricMethod<d>::couple(const CouplingChunk& chunk, const PerCluster& moments, PerCluster& coefficients) const {
  const Operators<d>& operators = *this->operators_;
  const std::size_t functions = operators.functions();
  const double side = this->tree_.side(chunk.level), scale = d == 3 ? 1 / side : 1,
               shift = std::log(side) + this->problem_.log_shift;
  Buffer<double> from, to;
  std::size_t begin = 0;
  for (const CouplingChunk::Group& group : chunk.groups) {
    const std::size_t pairs = group.end - begin;
    int k[3] = {};
    for (std::size_t l = 0; l < d; ++l) k[l] = std::abs(group.k[l]);
    const std::size_t reflection = Operators<d>::reflection(group.k);
    for (const Coupling::Block& block : operators.coupling(k).blocks) {
      const std::size_t size = block.functions.size();
      from.resize(pairs * size);
      to.assign(pairs * size, 0.0);
      for (std::size_t p = 0; p < pairs; ++p) {
        const double* const moment = moments.data() + chunk.pairs[begin + p].source * functions;
        double* next = from.data() + p * size;
        for (const Coupling::Run& run : block.runs) {
          const double* const some = moment + operators.first_of(run.parity);
          const double factor = sign(run.parity, reflection) * scale;
          for (std::size_t b = 0; b < run.count; ++b) *next++ = some[b] * factor;
        }
      }
      fastest_kernels().product({.rows = pairs,
                                 .depth = size,
                                 .width = size,
                                 .a = from.data(),
                                 .a_stride = size,
                                 .b = block.matrix.data(),
                                 .b_stride = size,
                                 .c = to.data(),
                                 .c_stride = size});
      for (std::size_t p = 0; p < pairs; ++p) {
        double* const coefficient = coefficients.data() + chunk.pairs[begin + p].target * functions;
        const double* next = to.data() + p * size;
        for (const Coupling::Run& run : block.runs) {
          double* const some = coefficient + operators.first_of(run.parity);
          const double factor = sign(run.parity, reflection);
          for (std::size_t a = 0; a < run.count; ++a) some[a] += *next++ * factor;
        }
      }
    }
    if (d == 2)
      for (std::size_t p = begin; p < group.end; ++p)
        coefficients[chunk.pairs[p].target * functions] += shift * moments[chunk.pairs[p].source * functions];
    begin = group.end;
  }
}

template <int d>
void SymmetricMethod<d>::add_from_points(const Buffer<double>& charges, PerCluster& coefficients) const {
  const Interpolation<d>& interpolation = this->operators_->one_sided();
  const std::size_t functions = this->operators_->functions();
  if (this->partition_.from_points.entries.empty()) return;
  const double seconds = this->work_.substitute_pairs * pair_seconds(this->problem_, Precision::full);
  gaussdrift::base::parallel_for({this->tree_.clusters().size(), seconds}, this->threads_, [&](std::size_t i) {
    const std::size_t count = this->partition_.from_points.count(i);
    if (count == 0) return;
    std::vector<double> values(interpolation.nodes()), sum(interpolation.nodes()),
        fitted(detail::functions<d>(interpolation.degree()));
    const Index* const leaves = this->partition_.from_points.first(i);
    double charge = 0;
    for (std::size_t n = 0; n < count; ++n) {
      const Range range = this->tree_.clusters()[leaves[n]].sources;
      this->near_.at_nodes(this->tree_.clusters()[i], interpolation, range, charges, values.data());
      for (std::size_t k = 0; k < values.size(); ++k) sum[k] += values[k];
      for (std::size_t j = range.begin; j < range.end; ++j) charge += charges[j];
    }
    interpolation.fit(sum.data(), fitted.data());
    if (d == 2) fitted[0] += this->problem_.log_shift * charge;
    for (std::size_t k = 0; k < fitted.size(); ++k)
      coefficients[i * functions + this->operators_->place(k)] += fitted[k];
  });
}

namespace {

template <template <int> class Method, int d>
std::unique_ptr<Summation> make(const Problem& problem, typename Clustered<d>::Parts parts) {
  return std::make_unique<Method<d>>(problem, std::move(parts));
}

}  // namespace

MethodEntry tree_method() {
  return {.method = Method::tree,
          .name = "tree",
          .meaning =
              "clusters of sources are replaced by substitute charges, which act on every target; for few targets, "
              "or few points with a tolerance of six digits",
          .replaces_clusters = true,
          .make = {make<TreeMethod, 2>, make<TreeMethod, 3>}};
}

MethodEntry symmetric_method() {
  return {.method = Method::symmetric,
          .name = "symmetric",
          .meaning = "clusters of targets are replaced as well, in linear time; for many sources and many targets",
          .replaces_clusters = true,
          .couples_clusters = true,
          .make = {make<SymmetricMethod, 2>, make<SymmetricMethod, 3>}};
}

template class Clustered<2>;
template class Clustered<3>;
template class TreeMethod<2>;
template class TreeMethod<3>;
template class SymmetricMethod<2>;
template class SymmetricMethod<3>;

}  // namespace farfield::detail
