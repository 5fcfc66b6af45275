// GeneralPlan, and how its choice is told.
#include <cmath>
#include <ostream>

#include "core/arguments.hpp"
#include "farfield/general/engine.hpp"

namespace farfield {

template <int d>
GeneralPlan<d>::GeneralPlan(const KernelFunction& kernel, const Eigen::Ref<const Points<d>>& sources,
                            const Eigen::Ref<const Points<d>>& targets, const GeneralOptions& options)
    : engine_(std::make_unique<detail::GeneralEngine<d>>(kernel, sources, &targets, options)) {}

template <int d>
GeneralPlan<d>::GeneralPlan(const KernelFunction& kernel, const Eigen::Ref<const Points<d>>& points,
                            const GeneralOptions& options)
    : engine_(std::make_unique<detail::GeneralEngine<d>>(kernel, points, nullptr, options)) {}

template <int d>
GeneralPlan<d>::~GeneralPlan() = default;
template <int d>
GeneralPlan<d>::GeneralPlan(GeneralPlan&&) noexcept = default;
template <int d>
GeneralPlan<d>& GeneralPlan<d>::operator=(GeneralPlan&&) noexcept = default;

template <int d>
Eigen::VectorXd GeneralPlan<d>::evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges,
                                         GeneralSeconds* seconds) const {
  GeneralSeconds ignored;
  return engine_->evaluate(charges, seconds ? *seconds : ignored);
}

template <int d>
const GeneralChoice& GeneralPlan<d>::choice() const {
  return engine_->choice();
}

template class GeneralPlan<2>;
template class GeneralPlan<3>;

const std::vector<GeneralMethod>& general_methods() {
  static const std::vector<GeneralMethod> all{GeneralMethod::automatic, GeneralMethod::direct,
                                              GeneralMethod::interpolation};
  return all;
}

std::string to_string(GeneralMethod method) {
  if (method == GeneralMethod::automatic) return "auto";
  return method == GeneralMethod::direct ? "direct" : "interpolation";
}

std::string meaning(GeneralMethod method) {
  switch (method) {
    case GeneralMethod::direct:
      return "sums every pair";
    case GeneralMethod::interpolation:
      return "clusters that are apart are coupled by polynomials that interpolate the kernel, recompressed: an H2 "
             "matrix";
    default:
      return "the method with the smaller predicted time";
  }
}

std::ostream& operator<<(std::ostream& out, const GeneralChoice& choice) {
  using gaussdrift::core::text;
  if (choice.method == GeneralMethod::direct)
    return out << to_string(choice.method) << ", " << text(choice.pairs) << " pairs";
  out << to_string(choice.method) << ", " << text(choice.pairs) << " pairs, orders";
  for (const GeneralLevel& level : choice.levels) out << " " << level.order;
  out << ", ranks";
  for (const GeneralLevel& level : choice.levels) out << " " << level.rank;
  const auto megabytes = [](double bytes) { return text(std::ceil(bytes / 1e5) / 10); };
  return out << ", bases " << megabytes(choice.basis_bytes) << " MB, couplings " << megabytes(choice.coupling_bytes)
             << " MB, measured error " << text(choice.measured);
}

}  // namespace farfield
