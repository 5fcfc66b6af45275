#include "effect/pair_velocity.hpp"

#include <fmt/format.h>

#include "base/users_words.hpp"
#include "gaussdrift/error.hpp"

namespace gaussdrift {

namespace {

template <int d>
farfield::Points<d> field_of(farfield::Kernel kernel, const PointsView& x, const std::vector<double>& weights,
                             const farfield::Options& options, std::unique_ptr<farfield::Plan<d>>& plan,
                             farfield::Choice& choice) {
  farfield::Points<d> points(d, static_cast<Eigen::Index>(x.count));
  for (std::size_t j = 0; j < x.count; ++j)
    for (int k = 0; k < d; ++k) points(k, static_cast<Eigen::Index>(j)) = x.axis[k][j];
  try {
    auto next = std::make_unique<farfield::Plan<d>>(kernel, points, options);
    plan = std::move(next);
    choice = plan->choice();
    return plan->evaluate(Eigen::Map<const Eigen::VectorXd>(weights.data(), static_cast<Eigen::Index>(weights.size())))
        .field;
  } catch (const farfield::MemoryLimitError& error) {
    throw InputError(
        fmt::format("the velocities that particles give each other would take {:.3g} GB of memory, and at most {:.3g} "
                    "GB are used. Lower particles.per_axis.",
                    error.needed / 1e9, static_cast<double>(error.limit) / 1e9));
  } catch (const farfield::RangeError& error) {
    throw NumericalError(
        fmt::format("the {} at particle {} (counted from 1) exceeds the range of double precision; its "
                    "weight is too large, or it lies too close to another",
                    error.quantity, error.target + 1));
  } catch (const farfield::Error& error) {  // positions or weights that are not finite, points too close
    throw NumericalError(
        fmt::format("the velocities that particles give each other cannot be summed: {}",
                    base::in_users_words(error.what(), {{"Options::tolerance = ", "a tolerance of "}})));
  }
}

}  // namespace

farfield::Points<2> PairVelocity::vortices(const PointsView& x, const std::vector<double>& weights, double core) const {
  ++evaluations_;
  return field_of<2>(farfield::Kernel::vortex_blob, x, weights,
                     {.tolerance = tolerance_, .threads = threads_, .core_radius = core, .potential = false}, plane_,
                     choice_);
}

farfield::Points<3> PairVelocity::charges(const PointsView& x, const std::vector<double>& weights) const {
  ++evaluations_;
  return field_of<3>(farfield::Kernel::coulomb, x, weights,
                     {.tolerance = tolerance_, .threads = threads_, .potential = false}, space_, choice_);
}

}  // namespace gaussdrift
