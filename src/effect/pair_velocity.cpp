#include "effect/pair_velocity.hpp"

#include <fmt/format.h>

#include <exception>

#include "effect/pair_images.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

/// Throws the words of this program for an error of farfield. id_of(target): of a particle.
template <class Work, class IdOf>
void in_words_of_particles(const Work& work, const IdOf& id_of) {
  try {
    work();
  } catch (const farfield::MemoryLimitError& error) {
    throw InputError(
        fmt::format("the velocities that particles give each other would take {:.3g} GB of memory, and at most {:.3g} "
                    "GB are used. Lower particles.per_axis.",
                    error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const farfield::RangeError& error) {
    throw NumericalError(
        fmt::format("the {} at particle {} exceeds the range of double precision; its weight is too large, or it lies "
                    "too close to another",
                    error.quantity, id_of(error.target)));
  } catch (const farfield::Error& error) {  // positions or weights that are not finite, points too close
    throw NumericalError(fmt::format("the velocities that particles give each other cannot be summed: {}",
                                     in_words_of_domains(error.what())));
  }
}

}  // namespace

PairVelocity::PairVelocity(double tolerance, int threads, base::Communicator* ranks, const Domain& domain)
    : tolerance_(tolerance),
      threads_(threads),
      ranks_(ranks && ranks->size() > 1 ? ranks : nullptr),
      axes_(axes_of(domain)) {
  if (ranks_ && (domain.has(Edge::periodic) || domain.has(Edge::closed)))
    throw InputError(
        fmt::format("velocities that images of particles beyond periodic and closed edges give are summed on one rank "
                    "alone, so that "
                    "{} ranks cannot share this case; start it on one rank",
                    ranks_->size()));
  if (ranks_) farfield_ranks_ = std::make_unique<FarfieldRanks>(*ranks_);
}

template <int d>
farfield::Points<d> PairVelocity::field_of(farfield::Kernel kernel, const PointsView& x,
                                           const std::vector<std::int64_t>& ids, const std::vector<double>& weights,
                                           const farfield::Options& options,
                                           std::unique_ptr<farfield::Plan<d>>& plan) const {
  ++evaluations_;
  farfield::Points<d> points(d, static_cast<Eigen::Index>(x.count)), field;
  for (std::size_t j = 0; j < x.count; ++j)
    for (int k = 0; k < d; ++k) points(k, static_cast<Eigen::Index>(j)) = x.axis[k][j];
  const Eigen::Map<const Eigen::VectorXd> charges(weights.data(), static_cast<Eigen::Index>(weights.size()));
  const auto sum = [&] {
    auto next = ranks_ ? std::make_unique<farfield::Plan<d>>(kernel, points, ids, options, *farfield_ranks_)
                       : std::make_unique<farfield::Plan<d>>(kernel, points, options);
    plan = std::move(next);
    choice_ = plan->choice();
    field = plan->evaluate(charges).field;
  };
  const auto sum_in_words = [&] {
    in_words_of_particles(
        sum, [&](std::size_t target) { return ranks_ ? static_cast<std::int64_t>(target) : ids.at(target); });
  };
  if (!ranks_) {
    sum_in_words();
    return field;
  }
  farfield_ranks_->begin();
  try {
    ranks_->agree_on(sum_in_words);
  } catch (...) {
    // Ranks that have failed inside of the sum agree on that twice: there, and at its end.
    if (farfield_ranks_->failed_together()) throw;
    ranks_->agree(std::current_exception());
  }
  return field;
}

farfield::Points<2> PairVelocity::vortices(const PointsView& x, const std::vector<std::int64_t>& ids,
                                           const std::vector<double>& weights, double core,
                                           farfield::MirrorImages mirrored) const {
  return field_of<2>(farfield::Kernel::vortex_blob, x, ids, weights,
                     {.tolerance = tolerance_,
                      .threads = threads_,
                      .core_radius = core,
                      .potential = false,
                      .axes = axes_,
                      .mirror_images = mirrored},
                     plane_);
}

farfield::Points<3> PairVelocity::charges(const PointsView& x, const std::vector<std::int64_t>& ids,
                                          const std::vector<double>& weights) const {
  return field_of<3>(farfield::Kernel::coulomb, x, ids, weights,
                     {.tolerance = tolerance_, .threads = threads_, .potential = false, .axes = axes_}, space_);
}

}  // namespace gaussdrift
